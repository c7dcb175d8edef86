// Preloaded into a program (LD_PRELOAD): ends it at a chosen change of its files, so that a test leaves no timing to
// chance. Between two changes of files all moments of a kill are alike.
//   KILL_BEFORE=N            SIGKILL in place of the N-th change, from 0
//   KILL_AFTER_CHECKPOINT=N  KILL_SIGNAL (a number, default SIGKILL) after the N-th checkpoint came into place, from 1
//   COUNT_FILE               how many changes there were is written to this file at the end
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdlib>
#include <cstring>

namespace {

long number(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atol(text);
}

long changes = 0, checkpoints = 0;

void change() {
  static const long last = number("KILL_BEFORE", -1);
  if (changes++ == last) ::kill(::getpid(), SIGKILL);
}

void renamed_to(const char* file) {
  static const long last = number("KILL_AFTER_CHECKPOINT", -1);
  constexpr const char* name = "checkpoint.bin";
  const std::size_t length = std::strlen(file), end = std::strlen(name);
  if (length < end || std::strcmp(file + length - end, name) != 0) return;
  if (++checkpoints == last) ::kill(::getpid(), static_cast<int>(number("KILL_SIGNAL", SIGKILL)));
}

/// The function of this name that would have been called.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

struct Counter {
  ~Counter() {
    const long counted = changes;  // before this file comes
    const char* file = std::getenv("COUNT_FILE");
    FILE* stream = file == nullptr ? nullptr : ::fopen(file, "w");
    if (stream == nullptr) return;
    ::fprintf(stream, "%ld\n", counted);
    ::fclose(stream);
  }
} counter;

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* data, size_t size) {
  change();
  return ::syscall(SYS_write, descriptor, data, size);
}

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t offset) {
  change();
  return ::syscall(SYS_pwrite64, descriptor, data, size, offset);
}

int ftruncate(int descriptor, off_t size) noexcept {
  change();
  return static_cast<int>(::syscall(SYS_ftruncate, descriptor, size));
}

int posix_fallocate(int descriptor, off_t offset, off_t size) {
  change();
  return next<int(int, off_t, off_t)>("posix_fallocate")(descriptor, offset, size);
}

int rename(const char* from, const char* to) noexcept {
  change();
  const int result = static_cast<int>(::syscall(SYS_rename, from, to));
  renamed_to(to);
  return result;
}

int unlink(const char* file) noexcept {
  change();
  return static_cast<int>(::syscall(SYS_unlink, file));
}

int remove(const char* file) noexcept {
  change();
  return next<int(const char*)>("remove")(file);
}

int mkdir(const char* folder, mode_t mode) noexcept {
  change();
  return static_cast<int>(::syscall(SYS_mkdir, folder, mode));
}

int open(const char* file, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0) {
    change();
    va_list arguments;
    va_start(arguments, flags);
    mode = va_arg(arguments, mode_t);
    va_end(arguments);
  }
  return static_cast<int>(::syscall(SYS_open, file, flags, mode));
}

FILE* fopen(const char* file, const char* mode) {
  if (mode[0] == 'w') change();
  return next<FILE*(const char*, const char*)>("fopen")(file, mode);
}

}  // extern "C"
