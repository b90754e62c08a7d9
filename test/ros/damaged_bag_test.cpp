// Bags whose lengths and places are wrong: refused with the byte, before rosbag believes them.
#include "scan_image_slam/ros/bag_input.h"
#include "support_folder.h"

#include <cstring>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <sensor_msgs/LaserScan.h>

namespace scan_image_slam {
namespace {

constexpr std::uint32_t kWild = 0xFFFFFFF0;
constexpr int kScans = 3;

sensor_msgs::LaserScan Scan(int index) {
  sensor_msgs::LaserScan scan;
  scan.header.stamp = ros::Time(100.0 + 0.025 * index);
  scan.header.frame_id = "laser";
  scan.angle_min = -1.5f;
  scan.angle_increment = 0.25f;
  scan.angle_max = 1.5f;
  scan.range_max = 30.0f;
  scan.ranges.assign(13, 2.0f);
  return scan;
}

class DamagedBag : public ::testing::Test {
 protected:
  /// The bytes of a bag with three scans.
  std::string Bag(rosbag::CompressionType compression = rosbag::compression::Uncompressed) const {
    rosbag::Bag bag(folder_.File("whole.bag"), rosbag::bagmode::Write);
    bag.setCompression(compression);
    for (int i = 0; i < kScans; ++i) bag.write("/scan", Scan(i).header.stamp, Scan(i));
    bag.close();
    std::ifstream file(folder_.File("whole.bag"), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Plays a bag of these bytes; says why it is refused, or else which of its messages are, or
  /// nothing.
  std::string Play(const std::string& bytes) const {
    try {
      BagInput input(folder_.Write("some.bag", bytes), BagTopics(), SlamOptions());
      SlamPipeline pipeline(SlamOptions(), [](const PipelineResult&) {});
      const auto run = [](Stage, const std::function<void()>& work) { work(); };
      input.Play(&pipeline, run, [](double) {});
      std::string refused;
      for (const auto& [reason, times] : input.refused()) {
        refused += std::to_string(times) + " x " + reason;
      }
      return refused;
    } catch (const BagError& error) {
      return folder_.WithoutPath(error.what());
    }
  }

  const TemporaryFolder folder_;
};

/// Where a text ends that stands before the value; of several the one with that index.
std::size_t After(const std::string& bytes, const std::string& name, int index = 0) {
  std::size_t at = bytes.find(name);
  for (int i = 0; i < index; ++i) at = bytes.find(name, at + 1);
  if (at == std::string::npos) throw std::logic_error("no " + name);
  return at + name.size();
}

template <typename Number>
std::string With(std::string bytes, std::size_t at, Number number) {
  std::memcpy(&bytes.at(at), &number, sizeof number);
  return bytes;
}

/// Where the entries of the index begin: behind its header, which ends with its version, and its
/// length. Each has a time and, 8 bytes on, the message's place in the chunk.
std::size_t IndexEntry(const std::string& bytes, int index) {
  constexpr std::size_t kVersionAndLength = 8;
  constexpr std::size_t kEntry = 12;
  return After(bytes, "ver=") + kVersionAndLength + kEntry * static_cast<std::size_t>(index);
}

/// Where the length of a message is: behind its header, which ends with its time.
std::size_t MessageLength(const std::string& bytes, int index) {
  constexpr std::size_t kTime = 8;
  return After(bytes, "time=", index) + kTime;
}

#define EXPECT_TOLD(text, words) EXPECT_NE((text).find(words), std::string::npos) << (text)

TEST_F(DamagedBag, WholeOnesArePlayed) {
  EXPECT_EQ(Play(Bag()), "");
  EXPECT_EQ(Play(Bag(rosbag::compression::BZ2)), "");
  EXPECT_EQ(Play(Bag(rosbag::compression::LZ4)), "");
}

TEST_F(DamagedBag, NoByteEndsTheProgramIfDamaged) {
  const std::string bytes = Bag();
  const std::string definition = ros::message_traits::Definition<sensor_msgs::LaserScan>::value();
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    if (bytes.compare(at, definition.size(), definition) == 0) at += definition.size();
    if (bytes[at] == ' ') continue;  // there is much room behind the header of the file
    const std::string told = Play(With(bytes, at, static_cast<char>(bytes[at] ^ 0x80)));
    if (at < bytes.find('\n')) {
      EXPECT_TOLD(told, "#ROSBAG V2.0");
    }
  }
}

TEST_F(DamagedBag, VersionsOfOldAreRefused) {
  EXPECT_TOLD(Play("#ROSBAG V1.2\n" + Bag().substr(13)), "does not begin with '#ROSBAG V2.0'");
  // rosbag has room for 100 letters there.
  EXPECT_TOLD(Play("#ROS" + std::string(1000, 'A') + " V2.0\n"), "does not begin with");
}

TEST_F(DamagedBag, EncryptedOnesAreRefused) {
  std::string bytes = Bag();
  const std::string field = "encryptor=rosbag/AesCbcEncryptor";
  const std::uint32_t length = static_cast<std::uint32_t>(field.size());
  std::uint32_t header = 0;
  std::memcpy(&header, &bytes.at(13), sizeof header);
  bytes = With(bytes, 13, header + 4 + length);
  bytes.insert(17, std::string(reinterpret_cast<const char*>(&length), 4) + field);
  EXPECT_TOLD(Play(bytes), "it is encrypted");
}

TEST_F(DamagedBag, PlacesBeyondTheEndAreTold) {
  const std::string bytes = Bag();
  const std::string end = "the file ends at byte " + std::to_string(bytes.size());
  EXPECT_TOLD(Play(With(bytes, After(bytes, "index_pos="), std::uint64_t{1} << 60)), end);
  EXPECT_TOLD(Play(With(bytes, After(bytes, "chunk_pos="), ~std::uint64_t{0})), end);
  EXPECT_TOLD(Play(With(bytes, After(bytes, "conn_count="), kWild)), "damaged at byte");
  EXPECT_TOLD(Play(With(bytes, After(bytes, "chunk_count="), kWild)), end);
  EXPECT_TOLD(Play(bytes.substr(0, bytes.size() - 1)), "damaged at byte");
}

TEST_F(DamagedBag, HeadersThatLieAboutTheirLengthAreTold) {
  const std::string bytes = Bag();
  EXPECT_TOLD(Play(With(bytes, 13, kWild)), "a header of 4294967280 bytes");
  const std::size_t field = After(bytes, "index_pos=") - std::strlen("index_pos=") - 4;
  EXPECT_TOLD(Play(With(bytes, field, kWild)), "a field leaves its header");
  EXPECT_TOLD(Play(With(bytes, After(bytes, "index_pos"), 'x')), "a field without a name");
  EXPECT_TOLD(Play(With(bytes, After(bytes, "index_po"), 'x')), "'index_pos' is missing");
}

TEST_F(DamagedBag, ChunksThatLieAboutTheirLengthAreTold) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string bytes = Bag(compression);
    const std::size_t size = After(bytes, "size=");
    EXPECT_TOLD(Play(With(bytes, size, kWild)), "a chunk of 4294967280 bytes");
    EXPECT_TOLD(Play(With(bytes, size, 9)), "damaged at byte");
  }
  const std::string bytes = Bag();
  EXPECT_TOLD(Play(With(bytes, After(bytes, "compression="), 'b')), "unknown compression");
}

TEST_F(DamagedBag, IndexThatPointsElsewhereIsTold) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string bytes = Bag(compression);
    const std::size_t place = IndexEntry(bytes, 1) + 8;
    EXPECT_TOLD(Play(With(bytes, place, kWild)), "a message leaves its chunk");
    // The chunk begins with the record of the connection.
    EXPECT_TOLD(Play(With(bytes, place, 0)), "not the expected record");
  }
  const std::string bytes = Bag();
  EXPECT_TOLD(Play(With(bytes, IndexEntry(bytes, 1) + 4, 1000000000)), "an impossible time");
  const std::size_t count = After(bytes, "count=", 2);  // after those of connections and chunks
  EXPECT_TOLD(Play(With(bytes, count, kWild)), "damaged at byte");
  const std::size_t connection = bytes.rfind("conn=", bytes.find("ver=")) + 5;
  EXPECT_TOLD(Play(With(bytes, connection, 7)), "messages of no known topic");
}

TEST_F(DamagedBag, FirstWritersOfThisVersionGaveTheIndexAnotherLength) {
  const std::string bytes = Bag();
  EXPECT_EQ(Play(With(bytes, IndexEntry(bytes, 0) - 4, 20 * kScans)), "");
}

TEST_F(DamagedBag, NothingIsReadTwice) {
  const std::string bytes = Bag();
  const std::string first = bytes.substr(IndexEntry(bytes, 0) + 8, 4);
  std::string twice = bytes;
  twice.replace(IndexEntry(bytes, 1) + 8, 4, first);
  EXPECT_TOLD(Play(twice), "messages overlap");

  // The record of the chunk is the last one; its header begins with its length and its first field.
  const std::size_t record = bytes.rfind("chunk_pos=") - 8;
  EXPECT_TOLD(Play(With(bytes, After(bytes, "chunk_count="), 2) + bytes.substr(record)),
              "chunks overlap");
}

TEST_F(DamagedBag, MessagesThatLeaveTheirChunkAreTold) {
  const std::string bytes = Bag();
  EXPECT_TOLD(Play(With(bytes, MessageLength(bytes, 1), kWild)), "a message leaves its chunk");
}

TEST_F(DamagedBag, AMessageWithoutBytesIsRefused) {
  const std::string bytes = Bag();
  EXPECT_EQ(Play(With(bytes, MessageLength(bytes, 1), 0)),
            "1 x /scan: a message of 0 bytes is shorter than it says");
}

TEST_F(DamagedBag, ArraysThatCantBeThereAreRefusedAndTheRestIsPlayed) {
  const std::string bytes = Bag();
  // Behind the length: number, stamp, frame with its length, seven numbers.
  const std::size_t ranges = MessageLength(bytes, 1) + 4 + 12 + 4 + 5 + 7 * 4;
  // Times the size of a float this is four bytes, in a number of 32 bits.
  for (const std::uint32_t length : {14U, 0x40000001U, kWild}) {
    const std::string told = Play(With(bytes, ranges, length));
    EXPECT_TOLD(told, "1 x /scan: a message of ");
    EXPECT_TOLD(told, " bytes is shorter than it says");
  }
}

}  // namespace
}  // namespace scan_image_slam
