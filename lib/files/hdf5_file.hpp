#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pliant {

/// Owner of one HDF5 handle.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*release)(hid_t)) : id_(id), release_(release) {}
  ~Hdf5Handle();
  Hdf5Handle(Hdf5Handle&& other) noexcept;
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  hid_t id() const { return id_; }

 private:
  hid_t id_;
  herr_t (*release_)(hid_t);
};

/// A row-major array, compressed, that is filled part by part.
class Hdf5Array {
 public:
  /// The rows that follow, whole ones.
  void append(const std::vector<float>& values);
  void append(const std::vector<int>& values);

 private:
  friend class Hdf5Group;
  Hdf5Array(std::filesystem::path file, std::string name, Hdf5Handle set, int columns);
  void append_values(hid_t memory_type, const void* values, std::size_t size);

  std::filesystem::path path_;
  std::string name_;
  Hdf5Handle set_;
  std::size_t columns_, rows_ = 0;  ///< rows: so far
};

/// A group being filled, unseen in its file until it is published.
class Hdf5Group {
 public:
  Hdf5Group(std::filesystem::path file, Hdf5Handle group);
  /// An array [rows x columns] of floats or integers; one column gives a one-dimensional dataset.
  Hdf5Array new_floats(const std::string& name, std::size_t rows, int columns);
  Hdf5Array new_integers(const std::string& name, std::size_t rows, int columns);
  /// All at once.
  void write(const std::string& name, const std::vector<float>& values, int columns);
  void write_attribute(const std::string& name, double value);

 private:
  friend class Hdf5File;
  Hdf5Array new_array(const std::string& name, hid_t file_type, std::size_t rows, int columns);

  std::filesystem::path path_;
  Hdf5Handle group_;
};

/// One open HDF5 file that stays readable whenever its writer is killed: groups are filled unseen, flushed, and only
/// then published and flushed, each by one small write (as far as the room for links and lists reaches). Every failure
/// is an OutputError that names the file, the object and what HDF5 says. The file is not locked, so that it may be
/// looked at while a run goes on.
class Hdf5File {
 public:
  enum class Mode { create, append };

  Hdf5File(const std::filesystem::path& file, Mode mode);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// `expected_links` makes room for later members of the group.
  Hdf5Group new_group(unsigned expected_links = 8);
  void publish(const Hdf5Group& group, const std::string& name);
  /// A one-dimensional dataset that grows by `append_value`.
  void write_empty_list(const std::string& name);
  void append_value(const std::string& name, double value);
  /// Number of values of a list.
  std::size_t list_size(const std::string& name);
  void shorten_list(const std::string& name, std::size_t size);
  bool has(const std::string& name) const;
  void remove(const std::string& name);
  /// Hands everything to the system.
  void flush();
  /// Flushes, closes and syncs to the disk. The destructor alone tells of no failure.
  void close();

 private:
  std::filesystem::path path_;
  hid_t file_ = H5I_INVALID_HID;
};

/// Makes sure that an existing, closed file can grow by `bytes`: HDF5 that runs out of disk half-way may spoil the
/// index of what the file held before. The room is taken from the disk and given back when the file is next closed.
/// Throws OutputError on a full disk, a quota or a limit of the file's size.
void reserve_disk_space(const std::filesystem::path& file, std::uintmax_t bytes);

}  // namespace pliant
