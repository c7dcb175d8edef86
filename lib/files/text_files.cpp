#include "files/text_files.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>

#include "core/errors.hpp"

namespace pliant {
namespace {

/// Rows are handed to the system in blocks of about this many bytes.
constexpr std::size_t csv_block = 1 << 16;

[[noreturn]] void fail(const std::filesystem::path& file, const char* action, int error) {
  throw OutputError(fmt::format("{}: cannot {}: {}; check the folder, its permissions and the free disk space",
                                file.string(), action, std::strerror(error)));
}

/// 0, or the errno of the write that failed.
int write_all(int descriptor, const std::string& content) {
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::write(descriptor, content.data() + done, content.size() - done);
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return 0;
}

/// 0, or the errno of the first of write, fsync and close that failed. The descriptor is closed in any case.
int write_and_close(int descriptor, const std::string& content) {
  int error = write_all(descriptor, content);
  if (error == 0 && ::fsync(descriptor) != 0) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  return error;
}

/// Makes a rename itself durable. Some file systems cannot sync a folder; the file is whole all the same.
void sync_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string result = "\"";
  for (const char c : cell) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

void write_file_atomically(const std::filesystem::path& file, const std::string& content) {
  std::filesystem::path temporary = file;
  temporary += fmt::format(".{}.tmp", ::getpid());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(file, "be created", errno);
  int error = write_and_close(descriptor, content);
  if (error == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(file, "be written", error);
  }
  sync_folder(file);
}

CsvFile::CsvFile(const std::filesystem::path& file, const std::vector<std::string>& columns, Opening opening)
    : path_(file), columns_(columns.size()) {
  file_ = std::fopen(file.c_str(), opening == Opening::create ? "wbe" : "r+be");
  if (file_ == nullptr) fail(path_, opening == Opening::create ? "be created" : "be opened", errno);
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
  if (::ftruncate(::fileno(file_), whole) != 0) fail(path_, "be cut back to the checkpoint", errno);
  ::lseek(::fileno(file_), whole, SEEK_SET);
}

void CsvFile::sync() {
  if (::fsync(::fileno(file_)) != 0 && errno != EINVAL) fail(path_, "be written", errno);
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
    fail(path_, "be written", error);
  }
  written_ += pending_.size();
  pending_.clear();
}

}  // namespace pliant
