#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pliant {

/// The text of an input file, without the byte-order mark of UTF-8 that some programs begin files with. Throws
/// InputError when it cannot be read or is UTF-16, be it without its mark; `what` says what the user should name there,
/// such as "a scene file (.toml)".
std::string read_text_file(const std::filesystem::path& file, const std::string& what);

/// The lines of an input file one after another, and errors that name the present one.
class LineReader {
 public:
  LineReader(std::string file, std::string_view text) : file_(std::move(file)), rest_(text) {}
  bool next();  ///< to the next line; false behind the last one
  std::string_view line() const { return line_; }
  int number() const { return number_; }  ///< from 1
  const std::string& file() const { return file_; }
  /// Throws InputError "file:line: message".
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::string file_;
  std::string_view rest_, line_;
  int number_ = 0;
};

/// Throws InputError "file:line: message".
[[noreturn]] void fail_at_line(const std::string& file, int line, const std::string& message);

/// The parts of a line between separators; an empty field counts, but none is behind a separator at the end.
/// Blanks around fields are left out; where blanks are the separator, any number of them is one.
std::vector<std::string_view> fields_of(std::string_view line, char separator);

std::string_view trimmed(std::string_view text);

/// Whether the whole text is a finite number or an integer; then it is stored.
bool parse_number(std::string_view text, double& number);
bool parse_number(std::string_view text, int& number);

}  // namespace pliant
