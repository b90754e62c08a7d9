#include "scan_image_slam/core/mapping/state_file.h"

#include "state_fixtures.h"

#include <string>
#include <vector>

namespace scan_image_slam {
namespace {

/// Why bytes are refused; empty if they are not.
std::string Refusal(const std::string& bytes) {
  try {
    DecodeState(bytes);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

/// CRC-32 as of Ethernet, bit by bit.
std::uint32_t CheckSumOf(const std::string& bytes) {
  std::uint32_t sum = 0xFFFFFFFFU;
  for (const char c : bytes) {
    sum ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1U) != 0U ? 0xEDB88320U : 0U);
  }
  return ~sum;
}

constexpr std::size_t kContent = 24;  // first byte after the header

/// Four bytes set to a number, and the check sum to what it must be.
std::string Forged(std::string bytes, std::size_t at, std::uint32_t value) {
  const auto put = [&bytes](std::size_t begin, std::uint32_t number) {
    for (int i = 0; i < 4; ++i) bytes[begin + i] = static_cast<char>(number >> (8 * i));
  };
  put(at, value);
  put(12, CheckSumOf(bytes.substr(kContent)));
  return bytes;
}

TEST(StateFile, HoldsEveryNumberBitForBit) {
  const MapState state = DistinctNumbers().State();
  const std::string bytes = EncodeState(state);
  const MapState back = DecodeState(bytes);
  ExpectSame(back, state);
  EXPECT_EQ(EncodeState(back), bytes);
}

TEST(StateFile, AnEmptyMapIsAState) {
  const std::string bytes = EncodeState(MapState());
  EXPECT_EQ(bytes.size(), kContent + 7 * 4 + 2 * 8 + 3 * 8);  // counts and indices, the chain
  ExpectSame(DecodeState(bytes), MapState());
}

TEST(StateFile, BeginsAsItIsDescribed) {
  const std::string bytes = EncodeState(DistinctNumbers().State());
  EXPECT_EQ(bytes.substr(0, 12), std::string("SISTATE\n\3\0\0\0", 12));
  EXPECT_EQ(Forged(bytes, 8, 3), bytes) << "the check sum is that of its definition";
  EXPECT_EQ(bytes.substr(kContent, 4), std::string("\3\0\0\0", 4)) << "three keyframes";
}

TEST(StateFile, ThatEndsAnywhereTooEarlyIsRefused) {
  const std::string bytes = EncodeState(DistinctNumbers().State());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string reason = Refusal(bytes.substr(0, size));
    ASSERT_NE(reason, "") << size;
    if (size < kContent) continue;
    EXPECT_EQ(reason, "at byte " + std::to_string(size) + ": it ends here, " +
                          std::to_string(bytes.size() - size) + " bytes too early");
  }
  EXPECT_EQ(Refusal(bytes + "x"), "at byte " + std::to_string(bytes.size()) + ": 1 bytes too many");
}

TEST(StateFile, WithAnyBitTurnedIsRefused) {
  const std::string bytes = EncodeState(DistinctNumbers().State());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    ASSERT_NE(Refusal(damaged), "") << "bit " << bit;
  }
}

TEST(StateFile, OfAnotherKindOrVersionIsRefusedAsSuch) {
  EXPECT_EQ(Refusal("P5\n3 3\n255\n........."), "at byte 0: this is no state of a map");
  EXPECT_EQ(Refusal(""), "at byte 0: this is no state of a map");
  const std::string newer = Forged(EncodeState(MapState()), 8, 4);
  EXPECT_EQ(Refusal(newer), "at byte 8: its version is 4, this program reads version 3");
}

TEST(StateFile, CountsThatTheBytesCannotHoldAreRefusedBeforeAnythingIsMade) {
  const std::string bytes = EncodeState(DistinctNumbers().State());
  EXPECT_EQ(Refusal(Forged(bytes, kContent, 0xFFFFFFFFU)),
            "at byte 24: 4294967295 keyframes are more than the data can hold");
  // Number, stamp, way, joined, motion, covariance and laser of the first keyframe come before its
  // points.
  const std::size_t points = kContent + 4 + 4 + 8 + 8 + 1 + 3 * 8 + 9 * 8 + 2 * 8;
  EXPECT_EQ(
      Refusal(Forged(bytes, points, 1U << 31)),
      "at byte " + std::to_string(points) + ": 2147483648 points are more than the data can hold");
  // With every four bytes forged, whatever they mean: an error or a state, and no more memory.
  for (std::size_t at = kContent; at + 4 <= bytes.size(); ++at) {
    Refusal(Forged(bytes, at, 0xFFFFFFFFU));
    Refusal(Forged(bytes, at, 0x7FFFFFFFU));
  }
}

TEST(StateFile, WhatRefersToNothingIsRefused) {
  MapState state = DistinctNumbers().State();
  const auto refuses = [&state](int number) {
    const std::string reason = "there is no keyframe " + std::to_string(number) + " to refer to";
    const bool found = Refusal(EncodeState(state)).find(reason) != std::string::npos;
    state = DistinctNumbers().State();
    return found;
  };
  state.drawn.back().pose.keyframe = 4;
  EXPECT_TRUE(refuses(4));
  state.drawn.back().pose.keyframe = 1;
  EXPECT_EQ(Refusal(EncodeState(state)), "") << "it was let go, and has an anchor";
  state.graph.constraints.front().to = 1;
  EXPECT_TRUE(refuses(1));
  state.graph.constraints.front().to = 0;
  EXPECT_TRUE(refuses(0)) << "a keyframe is not tied to itself";
  state.graph.let_go[1].keyframe = 2;
  EXPECT_TRUE(refuses(2)) << "what knows a place was there before";
  state.graph.let_go[1].keyframe = 1;
  EXPECT_TRUE(refuses(1));
  state.graph.submaps[4] = {1, 2, 0.0};
  EXPECT_TRUE(refuses(1)) << "a submap of which nothing is left";
  state.graph.next_to_release = 0;
  EXPECT_TRUE(refuses(1)) << "what was let go was judged before";
}

TEST(StateFile, KeyframesComeInTheirOrder) {
  MapState state = DistinctNumbers().State();
  auto keyframe = std::make_shared<Keyframe>(*state.graph.keyframes[2]);
  keyframe->id = 0;
  state.graph.keyframes[2] = keyframe;
  EXPECT_NE(Refusal(EncodeState(state)).find("the index 0 is not between 1 and"),
            std::string::npos);
  state = DistinctNumbers().State();
  state.graph.keyframes.erase(0);
  state.graph.poses.erase(0);
  EXPECT_NE(Refusal(EncodeState(state)).find("the index 2 is not between 0 and 0"),
            std::string::npos)
      << "the first is never let go";
}

TEST(StateFile, NumbersThatAreNoneAreRefused) {
  MapState state = DistinctNumbers().State();
  state.graph.poses[1].y = std::nan("");
  EXPECT_NE(Refusal(EncodeState(state)).find("a number is not finite"), std::string::npos);
}

}  // namespace
}  // namespace scan_image_slam
