#include "scan_image_slam/ros/bag_check.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <rosbag/chunked_file.h>
#include <rosbag/constants.h>
#include <rosbag/exceptions.h>

namespace scan_image_slam {
namespace {

constexpr char kVersionLine[] = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMaxField = 1000000;   // [byte] what rosbag takes
constexpr std::uint32_t kMaxHeader = 1 << 24;  // [byte]
constexpr std::uint32_t kMaxChunk = 1 << 29;   // [byte] unpacked; usual are 768 kB

/// That many bytes from a place on; throws if they are not all there.
using ReadBytes = std::function<std::string(std::uint64_t begin, std::uint64_t size)>;
using Fields = std::map<std::string, std::string>;

[[noreturn]] void Fail(std::uint64_t byte, const std::string& what) {
  throw std::runtime_error("damaged at byte " + std::to_string(byte) + ": " + what);
}

template <typename Number>
Number ToNumber(const std::string& bytes) {
  Number number{};
  std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

template <typename Number>
Number ReadNumber(std::uint64_t begin, const ReadBytes& read) {
  return ToNumber<Number>(read(begin, sizeof(Number)));
}

/// Fields NAME=VALUE, each with its length before it.
Fields ReadFields(std::uint64_t begin, std::uint32_t size, const ReadBytes& read) {
  if (size > kMaxHeader) Fail(begin, "a header of " + std::to_string(size) + " bytes");
  Fields fields;
  const std::uint64_t end = begin + size;
  while (begin < end) {
    const auto length = ReadNumber<std::uint32_t>(begin, read);
    begin += sizeof length;
    if (length > kMaxField || begin + length > end) Fail(begin, "a field leaves its header");
    const std::string field = read(begin, length);
    const std::size_t equals = field.find('=');
    if (equals == std::string::npos) Fail(begin, "a field without a name");
    fields[field.substr(0, equals)] = field.substr(equals + 1);
    begin += length;
  }
  return fields;
}

/// A header with fields, and data that are all there.
class Record {
 public:
  Record(std::uint64_t begin, std::uint8_t kind, const ReadBytes& read) : begin_(begin) {
    const auto header_size = ReadNumber<std::uint32_t>(begin, read);
    const std::uint64_t header = begin + sizeof header_size;
    fields_ = ReadFields(header, header_size, read);
    data_size_ = ReadNumber<std::uint32_t>(header + header_size, read);
    data_ = header + header_size + sizeof data_size_;
    read(end(), 0);
    if (Field<std::uint8_t>(rosbag::OP_FIELD_NAME) != kind) {
      Fail(begin, "not the expected record (" + std::to_string(kind) + ")");
    }
  }

  std::uint64_t begin() const { return begin_; }
  std::uint64_t data() const { return data_; }
  std::uint32_t data_size() const { return data_size_; }
  std::uint64_t end() const { return data_ + data_size_; }

  /// Empty if there is none.
  std::string Text(const std::string& name) const {
    const auto field = fields_.find(name);
    return field == fields_.end() ? "" : field->second;
  }

  template <typename Number>
  Number Field(const std::string& name) const {
    const std::string text = Text(name);
    if (text.size() != sizeof(Number)) Fail(begin_, "field '" + name + "' is missing or damaged");
    return ToNumber<Number>(text);
  }

 private:
  std::uint64_t begin_;
  std::uint64_t data_ = 0;
  std::uint32_t data_size_ = 0;
  Fields fields_;
};

/// Where things begin and end; none may overlap another, or a small bag would hold much.
class Extents {
 public:
  void Add(std::uint64_t begin, std::uint64_t end) { extents_.emplace_back(begin, end); }

  void RequireDisjoint(const std::string& what) {
    std::sort(extents_.begin(), extents_.end());
    for (std::size_t i = 1; i < extents_.size(); ++i) {
      if (extents_[i].first < extents_[i - 1].second) Fail(extents_[i].first, what + " overlap");
    }
  }

 private:
  std::vector<std::pair<std::uint64_t, std::uint64_t>> extents_;
};

class BagChecker {
 public:
  explicit BagChecker(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    if (file_) size_ = static_cast<std::uint64_t>(file_.tellg());
  }

  void Check() {
    const std::size_t start = sizeof kVersionLine - 1;
    if (size_ < start || read_(0, start) != kVersionLine) {
      throw std::runtime_error("it does not begin with '#ROSBAG V2.0'");
    }
    const Record head(start, rosbag::OP_FILE_HEADER, read_);
    if (!head.Text(rosbag::ENCRYPTOR_FIELD_NAME).empty()) {
      throw std::runtime_error("it is encrypted");
    }
    std::uint64_t next = head.Field<std::uint64_t>(rosbag::INDEX_POS_FIELD_NAME);
    if (next == 0) return;
    const auto connections = head.Field<std::uint32_t>(rosbag::CONNECTION_COUNT_FIELD_NAME);
    for (std::uint32_t i = 0; i < connections; ++i) next = CheckConnection(next);
    const auto chunks = head.Field<std::uint32_t>(rosbag::CHUNK_COUNT_FIELD_NAME);
    for (std::uint32_t i = 0; i < chunks; ++i) next = CheckChunkInfo(next);
    chunks_.RequireDisjoint("chunks");
  }

 private:
  /// Each returns where the next record begins: behind the entries, as rosbag takes it, whose first
  /// writers gave an index another length.
  std::uint64_t CheckConnection(std::uint64_t begin) {
    const Record connection(begin, rosbag::OP_CONNECTION, read_);
    connections_.insert(connection.Field<std::uint32_t>(rosbag::CONNECTION_FIELD_NAME));
    ReadFields(connection.data(), connection.data_size(), read_);
    return connection.end();
  }

  std::uint64_t CheckChunkInfo(std::uint64_t begin) {
    const Record info(begin, rosbag::OP_CHUNK_INFO, read_);
    const auto count = info.Field<std::uint32_t>(rosbag::COUNT_FIELD_NAME);
    constexpr std::uint64_t kEntrySize = 8;
    std::uint64_t end = info.data();
    std::set<std::uint32_t> connections;
    for (std::uint32_t i = 0; i < count; ++i, end += kEntrySize) {
      connections.insert(ToNumber<std::uint32_t>(read_(end, kEntrySize)));
    }
    CheckChunk(info.Field<std::uint64_t>(rosbag::CHUNK_POS_FIELD_NAME), connections.size());
    return end;
  }

  void CheckChunk(std::uint64_t begin, std::size_t indices) {
    const Record chunk(begin, rosbag::OP_CHUNK, read_);
    std::uint64_t end = chunk.end();
    std::vector<std::uint32_t> messages;  // where they begin in the chunk
    for (std::size_t i = 0; i < indices; ++i) end = CheckIndex(end, &messages);
    chunks_.Add(begin, end);
    if (!messages.empty()) CheckMessages(messages, begin, Unpack(chunk));
  }

  std::uint64_t CheckIndex(std::uint64_t begin, std::vector<std::uint32_t>* messages) {
    const Record index(begin, rosbag::OP_INDEX_DATA, read_);
    if (connections_.count(index.Field<std::uint32_t>(rosbag::CONNECTION_FIELD_NAME)) == 0) {
      Fail(begin, "messages of no known topic");
    }
    const auto count = index.Field<std::uint32_t>(rosbag::COUNT_FIELD_NAME);
    constexpr std::uint64_t kEntrySize = 12;  // seconds, nanoseconds, place in the chunk
    std::uint64_t end = index.data();
    for (std::uint32_t i = 0; i < count; ++i, end += kEntrySize) {
      const std::string entry = read_(end, kEntrySize);
      if (ToNumber<std::uint32_t>(entry.substr(4)) >= 1000000000) Fail(end, "an impossible time");
      messages->push_back(ToNumber<std::uint32_t>(entry.substr(8)));
    }
    return end;
  }

  std::string Unpack(const Record& chunk) {
    const std::string packing = chunk.Text(rosbag::COMPRESSION_FIELD_NAME);
    const auto size = chunk.Field<std::uint32_t>(rosbag::SIZE_FIELD_NAME);
    const bool raw = packing == rosbag::COMPRESSION_NONE;
    if (size > kMaxChunk || (raw && size != chunk.data_size())) {
      Fail(chunk.begin(), "a chunk of " + std::to_string(size) + " bytes");
    }
    std::string packed = read_(chunk.data(), chunk.data_size());
    if (raw) return packed;
    if (packing != rosbag::COMPRESSION_BZ2 && packing != rosbag::COMPRESSION_LZ4) {
      Fail(chunk.begin(), "a chunk with an unknown compression");
    }
    const auto type =
        packing == rosbag::COMPRESSION_BZ2 ? rosbag::compression::BZ2 : rosbag::compression::LZ4;
    std::string content(size, '\0');
    try {
      unpacker_.decompress(type, reinterpret_cast<std::uint8_t*>(content.data()), size,
                           reinterpret_cast<std::uint8_t*>(packed.data()), chunk.data_size());
    } catch (const rosbag::BagException& error) {
      Fail(chunk.begin(), error.what());
    }
    return content;
  }

  static void CheckMessages(const std::vector<std::uint32_t>& messages, std::uint64_t chunk,
                            const std::string& content) {
    const ReadBytes read = [&](std::uint64_t begin, std::uint64_t size) {
      if (begin > content.size() || size > content.size() - begin) {
        Fail(chunk, "a message leaves its chunk");
      }
      return content.substr(begin, size);
    };
    Extents extents;
    for (const std::uint32_t begin : messages) {
      const Record message(begin, rosbag::OP_MSG_DATA, read);
      extents.Add(begin, message.end());
    }
    extents.RequireDisjoint("messages");
  }

  std::ifstream file_;
  std::uint64_t size_ = 0;  ///< [byte]
  const ReadBytes read_ = [this](std::uint64_t begin, std::uint64_t size) {
    if (begin > size_ || size > size_ - begin) {
      Fail(begin, "the file ends at byte " + std::to_string(size_) + ", but should go on");
    }
    std::string bytes(size, '\0');
    file_.seekg(static_cast<std::streamoff>(begin));
    if (!file_.read(bytes.data(), static_cast<std::streamsize>(size))) Fail(begin, "can't be read");
    return bytes;
  };
  rosbag::ChunkedFile unpacker_;
  std::set<std::uint32_t> connections_;
  Extents chunks_;
};

}  // namespace

void CheckBag(const std::string& path) { BagChecker(path).Check(); }

}  // namespace scan_image_slam
