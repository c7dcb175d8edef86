#include "files/text_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <iterator>

#include "core/errors.hpp"
#include "files/write_all.hpp"

namespace pliant {
namespace {

/// Rows are handed to the system in blocks of about this many bytes.
constexpr std::size_t csv_block = 1 << 16;

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string result = "\"";
  for (const char c : cell) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

CsvFile::CsvFile(const std::filesystem::path& file, const std::vector<std::string>& columns, Opening opening)
    : path_(file), columns_(columns.size()) {
  file_ = std::fopen(file.c_str(), opening == Opening::create ? "wbe" : "r+be");
  if (file_ == nullptr) refuse_file(path_, opening == Opening::create ? "be created" : "be opened", errno);
  std::string header;
  for (std::size_t i = 0; i < columns.size(); ++i) header += (i > 0 ? "," : "") + quoted(columns[i]);
  header += '\n';
  try {
    opening == Opening::create ? write_header(header) : require_header(header);
  } catch (...) {
    std::fclose(file_);  // no destructor runs for an object that was never complete
    throw;
  }
}

void CsvFile::write_header(const std::string& header) {
  pending_ = header;
  flush();
}

void CsvFile::require_header(const std::string& header) {
  std::string found(header.size(), '\0');
  if (std::fread(found.data(), 1, found.size(), file_) == found.size() && found == header) return;
  throw OutputError(
      fmt::format("{}: has other columns than this run; it was changed, or another run wrote it: start "
                  "anew (--force)",
                  path_.string()));
}

void CsvFile::loaded() {
  pending_.clear();
  const off_t whole = static_cast<off_t>(written_);
  if (::lseek(::fileno(file_), 0, SEEK_END) < whole)
    throw OutputError(
        fmt::format("{}: is shorter than at the checkpoint ({} bytes); it was changed: start anew "
                    "(--force)",
                    path_.string(), written_));
  if (::ftruncate(::fileno(file_), whole) != 0) refuse_file(path_, "be cut back to the checkpoint", errno);
  ::lseek(::fileno(file_), whole, SEEK_SET);
}

void CsvFile::sync() {
  if (::fsync(::fileno(file_)) != 0 && errno != EINVAL) refuse_file(path_, "be written", errno);
}

CsvFile::~CsvFile() {
  try {
    flush();
  } catch (const OutputError&) {
    // Whoever needs to know calls flush; the rows before are whole.
  }
  std::fclose(file_);
}

void CsvFile::row(const std::vector<double>& values) {
  if (values.size() != columns_) {
    throw OutputError(
        fmt::format("{}: a row of {} values was given, the header has {} columns; give one value a column",
                    path_.string(), values.size(), columns_));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) pending_ += ',';
    if (!std::isnan(values[i])) fmt::format_to(std::back_inserter(pending_), "{}", values[i]);
  }
  pending_ += '\n';
  if (pending_.size() >= csv_block) flush();
}

void CsvFile::flush() {
  if (pending_.empty()) return;
  const int error = write_all(::fileno(file_), pending_);
  if (error != 0) {
    // Cut a torn row off, so that the file stays readable; the rows are kept, should space be made.
    const off_t whole = static_cast<off_t>(written_);
    if (::ftruncate(::fileno(file_), whole) == 0) ::lseek(::fileno(file_), whole, SEEK_SET);
    refuse_file(path_, "be written", error);
  }
  written_ += pending_.size();
  pending_.clear();
}

}  // namespace pliant
