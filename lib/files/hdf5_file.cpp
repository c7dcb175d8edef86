#include "files/hdf5_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/errors.hpp"

namespace pliant {
namespace {

/// Level 1 with shuffle: higher levels cost several times the time for a few per cent of the size.
constexpr unsigned gzip_level = 1;
/// Rows of a chunk; one megabyte of three floats a row fits the chunk cache.
constexpr hsize_t chunk_rows = 1 << 16;
/// Values that a list holds before its index must grow.
constexpr hsize_t list_chunk = 1 << 11;
/// HDF5's largest room for a name in a group's header; a header holds 64 kB.
constexpr unsigned link_name_length = 6, largest_link_room = 2000;

/// The innermost message of HDF5's error stack: the one nearest to the cause.
std::string last_error() {
  std::string message = "unknown HDF5 error";
  const auto keep_first = [](unsigned depth, const H5E_error2_t* error, void* result) -> herr_t {
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(result) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &message);
  return message;
}

/// The handle or status of an HDF5 call; throws when it is negative.
hid_t checked(hid_t result, const std::filesystem::path& file, const std::string& object) {
  if (result >= 0) return result;
  throw OutputError(fmt::format("{}: cannot write '{}': {}; check the folder, its permissions and the free disk space",
                                file.string(), object, last_error()));
}

/// No locks: a reader that has the file open must not stop the run. Format of 1.8: a group's links lie in its header,
/// so that a link appears by one write.
Hdf5Handle file_access() {
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.id(), false, true);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18);
  return access;
}

/// How datasets, groups or files (`of`) are made: without time stamps, so that the same run gives the same bytes.
Hdf5Handle creation_of(hid_t of) {
  Hdf5Handle creation(H5Pcreate(of), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  return creation;
}

/// Chunked and compressed where there is something to compress.
Hdf5Handle compressed_creation(const std::array<hsize_t, 2>& shape, int rank) {
  Hdf5Handle creation = creation_of(H5P_DATASET_CREATE);
  if (shape[0] == 0 || shape[1] == 0) return creation;
  const std::array<hsize_t, 2> chunk = {std::min(shape[0], chunk_rows), shape[1]};
  H5Pset_chunk(creation.id(), rank, chunk.data());
  H5Pset_shuffle(creation.id());
  H5Pset_deflate(creation.id(), gzip_level);
  return creation;
}

/// Everything is closed here, so nothing is left for HDF5 to do at exit, where it crashes after a failed write.
void prepare_library() {
  static const herr_t prepared = H5dont_atexit();
  static_cast<void>(prepared);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
}

/// 0 or an errno.
int sync_file(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return error;
}

}  // namespace

Hdf5Handle::~Hdf5Handle() {
  if (id_ >= 0) release_(id_);
}

Hdf5Handle::Hdf5Handle(Hdf5Handle&& other) noexcept
    : id_(std::exchange(other.id_, H5I_INVALID_HID)), release_(other.release_) {}

Hdf5Group::Hdf5Group(std::filesystem::path file, Hdf5Handle group) : path_(std::move(file)), group_(std::move(group)) {}

Hdf5Array Hdf5Group::new_floats(const std::string& name, std::size_t rows, int columns) {
  return new_array(name, H5T_IEEE_F32LE, rows, columns);
}

Hdf5Array Hdf5Group::new_integers(const std::string& name, std::size_t rows, int columns) {
  return new_array(name, H5T_STD_I32LE, rows, columns);
}

void Hdf5Group::write(const std::string& name, const std::vector<float>& values, int columns) {
  new_floats(name, values.size() / static_cast<std::size_t>(columns), columns).append(values);
}

void Hdf5Group::write_attribute(const std::string& name, double value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const hid_t created = H5Acreate2(group_.id(), name.c_str(), H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT);
  const Hdf5Handle attribute(checked(created, path_, name), H5Aclose);
  checked(H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, &value), path_, name);
}

Hdf5Array Hdf5Group::new_array(const std::string& name, hid_t file_type, std::size_t rows, int columns) {
  const std::array<hsize_t, 2> shape = {rows, static_cast<hsize_t>(columns)};
  const int rank = columns > 1 ? 2 : 1;
  const Hdf5Handle space(checked(H5Screate_simple(rank, shape.data(), nullptr), path_, name), H5Sclose);
  const Hdf5Handle creation = compressed_creation(shape, rank);
  const hid_t created =
      H5Dcreate2(group_.id(), name.c_str(), file_type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT);
  return {path_, name, Hdf5Handle(checked(created, path_, name), H5Dclose), columns};
}

Hdf5Array::Hdf5Array(std::filesystem::path file, std::string name, Hdf5Handle set, int columns)
    : path_(std::move(file)),
      name_(std::move(name)),
      set_(std::move(set)),
      columns_(static_cast<std::size_t>(columns)) {}

void Hdf5Array::append(const std::vector<float>& values) {
  append_values(H5T_NATIVE_FLOAT, values.data(), values.size());
}

void Hdf5Array::append(const std::vector<int>& values) { append_values(H5T_NATIVE_INT, values.data(), values.size()); }

void Hdf5Array::append_values(hid_t memory_type, const void* values, std::size_t size) {
  if (size == 0) return;
  if (size % columns_ != 0)
    throw OutputError(
        fmt::format("{}: {} values of '{}' were given; its rows have {}", path_.string(), size, name_, columns_));
  const std::array<hsize_t, 2> begin = {rows_, 0}, count = {size / columns_, columns_};
  const Hdf5Handle memory(checked(H5Screate_simple(columns_ > 1 ? 2 : 1, count.data(), nullptr), path_, name_),
                          H5Sclose),
      space(checked(H5Dget_space(set_.id()), path_, name_), H5Sclose);
  checked(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), nullptr, count.data(), nullptr), path_, name_);
  checked(H5Dwrite(set_.id(), memory_type, memory.id(), space.id(), H5P_DEFAULT, values), path_, name_);
  rows_ += size / columns_;
}

Hdf5File::Hdf5File(const std::filesystem::path& file, Mode mode) : path_(file) {
  prepare_library();
  const Hdf5Handle access = file_access(), creation = creation_of(H5P_FILE_CREATE);
  file_ = checked(mode == Mode::create ? H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation.id(), access.id())
                                       : H5Fopen(file.c_str(), H5F_ACC_RDWR, access.id()),
                  path_, "/");
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

Hdf5Group Hdf5File::new_group(unsigned expected_links) {
  const Hdf5Handle creation = creation_of(H5P_GROUP_CREATE);
  H5Pset_link_phase_change(creation.id(), UINT16_MAX, 0);
  H5Pset_est_link_info(creation.id(), std::min(expected_links, largest_link_room), link_name_length);
  return {path_, Hdf5Handle(checked(H5Gcreate_anon(file_, creation.id(), H5P_DEFAULT), path_, "group"), H5Gclose)};
}

void Hdf5File::publish(const Hdf5Group& group, const std::string& name) {
  checked(H5Olink(group.group_.id(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), path_, name);
}

void Hdf5File::write_empty_list(const std::string& name) {
  const hsize_t size = 0, unlimited = H5S_UNLIMITED;
  const Hdf5Handle space(H5Screate_simple(1, &size, &unlimited), H5Sclose);
  const Hdf5Handle creation = creation_of(H5P_DATASET_CREATE);
  H5Pset_chunk(creation.id(), 1, &list_chunk);
  const hid_t created =
      H5Dcreate2(file_, name.c_str(), H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT);
  const Hdf5Handle set(checked(created, path_, name), H5Dclose);
}

void Hdf5File::append_value(const std::string& name, double value) {
  const Hdf5Handle set(checked(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), path_, name), H5Dclose);
  const Hdf5Handle before(checked(H5Dget_space(set.id()), path_, name), H5Sclose);
  const hsize_t size = static_cast<hsize_t>(H5Sget_simple_extent_npoints(before.id())), one = 1, larger = size + 1;
  checked(H5Dset_extent(set.id(), &larger), path_, name);
  const Hdf5Handle space(checked(H5Dget_space(set.id()), path_, name), H5Sclose);
  checked(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &size, nullptr, &one, nullptr), path_, name);
  const Hdf5Handle memory(H5Screate_simple(1, &one, nullptr), H5Sclose);
  checked(H5Dwrite(set.id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, &value), path_, name);
}

std::size_t Hdf5File::list_size(const std::string& name) {
  const Hdf5Handle set(checked(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), path_, name), H5Dclose);
  const Hdf5Handle space(checked(H5Dget_space(set.id()), path_, name), H5Sclose);
  return static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id()));
}

void Hdf5File::shorten_list(const std::string& name, std::size_t size) {
  const Hdf5Handle set(checked(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), path_, name), H5Dclose);
  const hsize_t extent = size;
  checked(H5Dset_extent(set.id(), &extent), path_, name);
}

bool Hdf5File::has(const std::string& name) const { return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0; }

void Hdf5File::remove(const std::string& name) { checked(H5Ldelete(file_, name.c_str(), H5P_DEFAULT), path_, name); }

void Hdf5File::flush() { checked(H5Fflush(file_, H5F_SCOPE_LOCAL), path_, "/"); }

void Hdf5File::close() {
  flush();
  checked(H5Fclose(std::exchange(file_, H5I_INVALID_HID)), path_, "/");
  const int error = sync_file(path_);
  if (error != 0) throw OutputError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(error)));
}

void reserve_disk_space(const std::filesystem::path& file, std::uintmax_t bytes) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  const off_t size = descriptor < 0 ? -1 : ::lseek(descriptor, 0, SEEK_END);
  const int error = size < 0 ? errno : ::posix_fallocate(descriptor, size, static_cast<off_t>(bytes));
  if (error != 0 && size >= 0 && ::ftruncate(descriptor, size) != 0) {
    // Space past the end is unused, not wrong: HDF5 cuts it off when it next closes the file.
  }
  if (descriptor >= 0) ::close(descriptor);
  if (error == 0) return;
  throw OutputError(
      fmt::format("{}: cannot grow by {} MB: {}; what it holds is complete: free some disk space, or write "
                  "fewer frames or fields",
                  file.string(), (bytes >> 20) + 1, std::strerror(error)));
}

}  // namespace pliant
