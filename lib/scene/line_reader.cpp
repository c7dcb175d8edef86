#include "scene/line_reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>

#include "core/errors.hpp"

namespace pliant {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view blanks = " \t\r";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::string_view utf16_marks[] = {"\xFF\xFE", "\xFE\xFF"};

template <class Number>
bool parse_whole(std::string_view text, Number& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

std::string read_text_file(const fs::path& file, const std::string& what) {
  constexpr std::uintmax_t largest = 256u << 20;
  const auto refuse = [&](const std::string& why) { throw InputError(fmt::format("{}: {}", file.string(), why)); };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status))
    refuse(error && status.type() == fs::file_type::none ? error.message() : "no such file; check the path");
  if (fs::is_directory(status)) refuse(fmt::format("is a folder; name {} in it", what));
  if (!fs::is_regular_file(status)) refuse(fmt::format("is not a regular file; name {}", what));
  if (fs::file_size(file, error) > largest) refuse(fmt::format("is larger than 256 MiB: not {}", what));
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad()) refuse("cannot be read; check its permissions");
  for (const std::string_view mark : utf16_marks)
    if (text.starts_with(mark)) refuse("is UTF-16; allowed: UTF-8, save it as that");
  if (text.size() > 1 && (text[0] == 0) != (text[1] == 0))
    refuse("every second byte is zero, as in UTF-16 without its mark; allowed: UTF-8, save it as that");
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  return text;
}

bool LineReader::next() {
  if (rest_.empty()) return false;
  const auto end = rest_.find('\n');
  line_ = trimmed(rest_.substr(0, end));
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  ++number_;
  return true;
}

void LineReader::fail(const std::string& message) const { fail_at_line(file_, number_, message); }

void fail_at_line(const std::string& file, int line, const std::string& message) {
  throw InputError(fmt::format("{}:{}: {}", file, line, message));
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  const bool by_blanks = separator == ' ';
  for (line = trimmed(line); !line.empty();) {
    const auto end = by_blanks ? line.find_first_of(blanks) : line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
    if (by_blanks) line = trimmed(line);
  }
  return fields;
}

bool parse_number(std::string_view text, double& number) { return parse_whole(text, number) && std::isfinite(number); }

bool parse_number(std::string_view text, int& number) { return parse_whole(text, number); }

}  // namespace pliant
