#include "scan_image_slam/core/mapping/atomic_file.h"

#include "support_folder.h"

#include <csignal>
#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace scan_image_slam {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public ::testing::Test {
 protected:
  std::string Error(const std::string& path, const std::string& content) const {
    try {
      ReplaceFile(path, content);
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }
  int Files() const {
    return static_cast<int>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  const TemporaryFolder folder_;
};

/// As if the disk were full: no file may grow beyond `bytes`.
class SmallFilesOnly {
 public:
  explicit SmallFilesOnly(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFilesOnly() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallFilesOnly(const SmallFilesOnly&) = delete;
  SmallFilesOnly& operator=(const SmallFilesOnly&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(AtomicFile, ReplacesTheContentAndLeavesNothingBeside) {
  const std::string path = folder_.File("state");
  ReplaceFile(path, std::string("old\0\n", 5));
  EXPECT_EQ(ReadWholeFile(path), std::string("old\0\n", 5));
  ReplaceFile(path, "new");
  EXPECT_EQ(ReadWholeFile(path), "new");
  EXPECT_EQ(Files(), 1);
}

TEST_F(AtomicFile, MakesTheFolder) {
  ReplaceFile(folder_.File("a/b/state"), "x");
  EXPECT_EQ(ReadWholeFile(folder_.File("a/b/state")), "x");
}

TEST_F(AtomicFile, ThatCannotBeWrittenWholeLeavesTheOldOne) {
  const std::string path = folder_.File("state");
  ReplaceFile(path, "old");
  std::string error;
  {
    const SmallFilesOnly full(1000);
    error = Error(path, std::string(5000, 'n'));
  }
  EXPECT_NE(error.find("can't write " + path), std::string::npos) << error;
  EXPECT_EQ(ReadWholeFile(path), "old");
  EXPECT_EQ(Files(), 1);
}

TEST_F(AtomicFile, OfSeveralNoneIsReplacedIfOneCannotBeWritten) {
  const std::string small = folder_.File("small");
  const std::string large = folder_.File("large");
  ReplaceFiles({{small, "old"}, {large, "old, too"}});
  {
    const SmallFilesOnly full(1000);
    try {
      ReplaceFiles({{small, "new"}, {large, std::string(5000, 'n')}});
      ADD_FAILURE();
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), "can't write " + large + ": File too large");
    }
  }
  EXPECT_EQ(ReadWholeFile(small), "old");
  EXPECT_EQ(ReadWholeFile(large), "old, too");
  EXPECT_EQ(Files(), 2);
  ReplaceFiles({{small, "new"}, {large, std::string(5000, 'n')}});
  EXPECT_EQ(ReadWholeFile(small), "new");
  EXPECT_EQ(ReadWholeFile(large), std::string(5000, 'n'));
}

TEST_F(AtomicFile, NamesWhatIsInTheWay) {
  fs::create_directories(folder_.File("state"));
  EXPECT_NE(Error(folder_.File("state"), "x").find(folder_.File("state")), std::string::npos);
  EXPECT_EQ(Files(), 1);
  ReplaceFile(folder_.File("file"), "x");
  EXPECT_NE(Error(folder_.File("file/state"), "x").find(folder_.File("file")), std::string::npos);
}

TEST_F(AtomicFile, ReadingNamesTheFile) {
  for (const std::string& path : {folder_.File("none"), folder_.path()}) {
    try {
      ReadWholeFile(path);
      ADD_FAILURE();
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace scan_image_slam
