// Rules of the source tree that no compiler checks: the headers of ROS lie in its default path.
#include "source_tree.h"

#include <regex>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const std::vector<std::string> kCpp = {".h", ".cpp"};
const std::vector<std::string> kCore = {"include/scan_image_slam/core", "src/core"};
const std::vector<std::string> kRos = {"include/scan_image_slam/ros", "src/ros"};
const std::vector<std::string> kPrograms = {"src/nodes", "src/tools", "src/rviz"};

std::vector<SourceFile> Sources(const std::vector<std::string>& folders) {
  std::vector<SourceFile> files = FilesBelow(folders, kCpp);
  EXPECT_GT(files.size(), 5U);
  return files;
}

/// Places where a pattern stands in code, neither in a comment nor in text.
std::vector<std::string> PlacesOf(const std::vector<SourceFile>& files, const std::string& regex) {
  const std::regex pattern(regex);
  std::vector<std::string> places;
  for (const SourceFile& file : files) {
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      if (std::regex_search(CodeOf(file.lines[i]), pattern)) {
        places.push_back(file.path + ":" + std::to_string(i + 1) + ": " + file.lines[i]);
      }
    }
  }
  return places;
}

using Places = std::vector<std::string>;

/// Includes of `files` for which `allowed` is false.
template <typename Allowed>
Places ForbiddenIncludes(const std::vector<SourceFile>& files, const Allowed& allowed) {
  Places forbidden;
  for (const SourceFile& file : files) {
    for (const std::string& include : IncludesOf(file)) {
      if (!allowed(include)) forbidden.push_back(file.path + " includes " + include);
    }
  }
  return forbidden;
}

TEST(Core, IncludesTheStandardLibraryAFewOthersAndItselfOnly) {
  const std::regex allowed(
      "<[a-z_]+>|<(Eigen|boost/container|opencv2|yaml-cpp|ceres)/.+>|<(zlib|fcntl|unistd|sys/"
      "stat)\\.h>|"
      "\"scan_image_slam/core/.+\"|\"[a-z_]+\\.h\"");
  EXPECT_EQ(ForbiddenIncludes(Sources(kCore),
                              [&](const std::string& i) { return std::regex_match(i, allowed); }),
            Places());
}

TEST(Core, DoesNotLog) {
  const std::vector<SourceFile> core = Sources(kCore);
  EXPECT_EQ(PlacesOf(core, R"(#include <(iostream|cstdio|print|syslog)>)"), Places());
  EXPECT_EQ(PlacesOf(core, R"(\b(cout|cerr|clog|printf|puts|fprintf|ROS_[A-Z_]+)\b)"), Places());
}

TEST(Core, ReadsNoClock) {
  const std::vector<SourceFile> core = Sources(kCore);
  EXPECT_EQ(PlacesOf(core, R"(#include <(chrono|ctime|sys/time|time)(\.h)?>)"), Places());
  EXPECT_EQ(PlacesOf(core, R"(\b(gettimeofday|clock_gettime|localtime|gmtime|steady_clock)\b)"),
            Places());
  EXPECT_EQ(PlacesOf(core, R"(\b(getTickCount|TickMeter)\b)"), Places());
}

TEST(Core, ReadsNoEnvironment) {
  EXPECT_EQ(PlacesOf(Sources(kCore), R"(\b(getenv|secure_getenv|environ|setlocale)\b)"), Places());
}

TEST(Core, TakesItsRandomSeedFromTheCaller) {
  EXPECT_EQ(
      PlacesOf(Sources(kCore), R"(\b(random_device|rand|srand|theRNG|default_random_engine)\b)"),
      Places());
}

TEST(Core, HasNoVariablesThatOutliveACall) {
  EXPECT_EQ(PlacesOf(Sources(kCore), R"(^\s*(static|thread_local) (?!const)[^(]*$)"), Places());
}

TEST(Programs, StartNoOthersAndLoadNoCode) {
  EXPECT_EQ(PlacesOf(Sources({"include", "src/core", "src/ros", "src/nodes"}),
                     R"(\b(system|popen|fork|vfork|exec[lv]p?e?|posix_spawnp?|dlopen)\s*\()"),
            Places());
}

TEST(Dependencies, OfRosArePointedAtTheCore) {
  EXPECT_EQ(ForbiddenIncludes(Sources(kRos),
                              [](const std::string& include) {
                                return include.find("nodes/") == std::string::npos &&
                                       include.find("tools/") == std::string::npos &&
                                       include.find("<rviz/") == std::string::npos &&
                                       include.find("<Q") == std::string::npos &&
                                       include.find("..") == std::string::npos;
                              }),
            Places());
}

TEST(Dependencies, OfProgramsAreHeadersOfThePackage) {
  // A program uses what others can use too, and at most helpers beside it.
  const std::regex own("\"(scan_image_slam/(core|ros)/.+|[a-z0-9_]+\\.h)\"|<.+>");
  EXPECT_EQ(ForbiddenIncludes(Sources(kPrograms),
                              [&](const std::string& i) { return std::regex_match(i, own); }),
            Places());
}

TEST(Dependencies, OfTheCoreStagesAreNotOnTheSimulation) {
  // The judge's truth and the sensors' models must not leak into what they judge.
  std::vector<SourceFile> stages;
  for (SourceFile& file : Sources(kCore)) {
    if (file.path.find("core/simulation/") == std::string::npos) stages.push_back(std::move(file));
  }
  EXPECT_EQ(ForbiddenIncludes(stages,
                              [](const std::string& include) {
                                return include.find("core/simulation/") == std::string::npos;
                              }),
            Places());
}

TEST(Files, AreNotLong) {
  constexpr std::size_t kMaxLines = 350;
  for (const SourceFile& file :
       FilesBelow({"include", "src", "test", "launch", "config", "scripts", "msg", "srv", "bench"},
                  {".h", ".cpp", ".py", ".sh", ".launch", ".test", ".yaml", ".msg", ".srv"})) {
    EXPECT_LE(file.lines.size(), kMaxLines) << file.path;
  }
}

TEST(Files, EndWithANewline) {
  namespace fs = std::filesystem;
  for (const SourceFile& file : FilesBelow({"include", "src", "test"}, kCpp)) {
    std::ifstream stream(fs::path(SCAN_IMAGE_SLAM_SOURCE_DIR) / file.path);
    stream.seekg(-1, std::ios::end);
    EXPECT_EQ(stream.get(), '\n') << file.path;
  }
}

TEST(Headers, AreGuardedAndInTheNamespace) {
  for (const SourceFile& file : FilesBelow({"include"}, {".h"})) {
    EXPECT_EQ(file.lines.front(), "#pragma once") << file.path;
    const auto has = [&](const std::string& line) {
      return std::find(file.lines.begin(), file.lines.end(), line) != file.lines.end();
    };
    EXPECT_TRUE(has("namespace scan_image_slam {")) << file.path;
    EXPECT_EQ(PlacesOf({file}, "^\\s*using namespace"), Places());
  }
}

TEST(Headers, SayWhatTheyAreFor) {
  for (const SourceFile& file : FilesBelow({"include"}, {".h"})) {
    const bool documented =
        std::any_of(file.lines.begin(), file.lines.end(), [](const std::string& line) {
          return StartsWith(line, "/// ");  // at the left edge: of a type or function
        });
    EXPECT_TRUE(documented) << file.path;
  }
}

TEST(Headers, AreIncludedFirstByTheirOwnSource) {
  // So they compile alone; CMakeLists.txt compiles the headers without a source.
  for (const SourceFile& file : FilesBelow({"src/core", "src/ros"}, {".cpp"})) {
    const std::string stem = file.path.substr(4, file.path.size() - 4 - 4);
    const std::string header = "include/scan_image_slam/" + stem + ".h";
    const std::filesystem::path root = SCAN_IMAGE_SLAM_SOURCE_DIR;
    if (!std::filesystem::exists(root / header)) continue;
    const std::vector<std::string> includes = IncludesOf(file);
    ASSERT_FALSE(includes.empty()) << file.path;
    EXPECT_EQ(includes.front(), "\"scan_image_slam/" + stem + ".h\"") << file.path;
  }
}

}  // namespace
}  // namespace scan_image_slam
