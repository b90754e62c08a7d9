#include "scan_image_slam/core/evaluation/stamp_text.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <system_error>

namespace scan_image_slam {
namespace {

constexpr std::uint64_t kNanosecondsPerSecond = 1000000000;
constexpr long kNanosecondDigits = 9;
constexpr long kMaxDigits = 19;  // of a 64 bit number

/// The number (negative ? -1 : 1) * digits * 10^exponent.
struct Decimal {
  bool negative = false;
  std::string digits;
  long exponent = 0;
};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

std::optional<long> ParseExponent(const std::string& text, std::size_t begin) {
  if (begin < text.size() && text[begin] == '+') {
    ++begin;  // from_chars knows only the minus sign
    if (begin < text.size() && text[begin] == '-') return std::nullopt;
  }
  int exponent = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + begin, end, exponent);
  if (error != std::errc() || rest != end) return std::nullopt;
  return exponent;
}

std::optional<Decimal> ParseDecimal(const std::string& text) {
  Decimal decimal;
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) decimal.negative = text[i++] == '-';
  while (i < text.size() && IsDigit(text[i])) decimal.digits += text[i++];
  if (i < text.size() && text[i] == '.') {
    for (++i; i < text.size() && IsDigit(text[i]); --decimal.exponent) decimal.digits += text[i++];
  }
  if (decimal.digits.empty()) return std::nullopt;
  if (i == text.size()) return decimal;
  if (text[i] != 'e' && text[i] != 'E') return std::nullopt;
  const std::optional<long> exponent = ParseExponent(text, i + 1);
  if (!exponent) return std::nullopt;
  decimal.exponent += *exponent;
  return decimal;
}

/// digits * 10^exponent, rounded to the nearest integer.
std::optional<Stamp> RoundToInteger(std::string digits, long exponent) {
  digits.erase(0, digits.find_first_not_of('0'));
  const long length = static_cast<long>(digits.size()) + exponent;  // digits before the point
  if (digits.empty() || length < 0) return 0;
  if (length > kMaxDigits) return std::nullopt;
  const std::size_t kept = static_cast<std::size_t>(length);
  const bool round_up = kept < digits.size() && digits[kept] >= '5';
  digits.resize(kept, '0');
  std::uint64_t value = 0;
  for (const char digit : digits) value = 10 * value + static_cast<std::uint64_t>(digit - '0');
  if (round_up) ++value;
  if (value > static_cast<std::uint64_t>(std::numeric_limits<Stamp>::max())) return std::nullopt;
  return static_cast<Stamp>(value);
}

}  // namespace

std::optional<Stamp> ParseStamp(const std::string& seconds) {
  const std::optional<Decimal> decimal = ParseDecimal(seconds);
  if (!decimal) return std::nullopt;
  const std::optional<Stamp> magnitude =
      RoundToInteger(decimal->digits, decimal->exponent + kNanosecondDigits);
  if (!magnitude) return std::nullopt;
  return decimal->negative ? -*magnitude : *magnitude;
}

std::string FormatStamp(Stamp stamp) {
  const bool negative = stamp < 0;
  const std::uint64_t bits = static_cast<std::uint64_t>(stamp);
  const std::uint64_t magnitude = negative ? 0 - bits : bits;
  const std::string fraction = std::to_string(magnitude % kNanosecondsPerSecond);
  return (negative ? "-" : "") + std::to_string(magnitude / kNanosecondsPerSecond) + "." +
         std::string(kNanosecondDigits - fraction.size(), '0') + fraction;
}

}  // namespace scan_image_slam
