// Temporary name, write, fsync, rename.
#include "builder/base/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "builder/base/error.h"

namespace copse {

namespace {

std::atomic<unsigned> temporaries{0};

/// The names of the temporary files that are there, where a signal handler finds them: in memory that is never freed.
struct Slot {
  std::atomic<bool> taken, ready;
  char name[4096];  // Longer ones cannot be opened.
};
Slot slots[16];

/// The number of the slot, or -1 where all are taken.
int keepName(const std::string& name) {
  for (int i = 0; i < 16; ++i) {
    if (name.size() >= sizeof slots[i].name || slots[i].taken.exchange(true)) continue;
    std::memcpy(slots[i].name, name.c_str(), name.size() + 1);
    slots[i].ready = true;
    return i;
  }
  return -1;
}

void releaseName(int slot) {
  if (slot < 0) return;
  slots[slot].ready = false;
  slots[slot].taken = false;
}

/// The file that a link stands for: renaming over the link itself would replace the link.
std::string followLink(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_symlink(file, ignored)) return file;
  // A link to what is not there yet has no canonical path: step by step. More steps than the system takes are a circle,
  // which stays and cannot be opened.
  if (!std::filesystem::exists(file, ignored)) {
    std::filesystem::path path = file;
    for (int steps = 0; steps < 40 && std::filesystem::is_symlink(path, ignored); ++steps)
      path = path.parent_path() / std::filesystem::read_symlink(path, ignored);
    return path.string();
  }
  const std::filesystem::path target = std::filesystem::weakly_canonical(file, ignored);
  return ignored ? file : target.string();
}

}  // namespace

WholeFile::WholeFile(const std::string& file) : file_(file), target_(followLink(file)) {
  if (file.empty()) throw InputError("an empty file name");
  struct stat status;
  const bool exists = ::stat(target_.c_str(), &status) == 0;
  if (!exists && errno == ELOOP) fail(ELOOP);
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (!exists && target_.back() == '/') fail(ENOENT);
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  // A file that its owner made read-only stays, though a rename would get past that.
  if (exists && ::access(target_.c_str(), W_OK) != 0) fail(errno);
  const std::filesystem::path folder = std::filesystem::path(target_).parent_path();
  for (;;) {
    temporary_ = (folder / (".copse-" + std::to_string(::getpid()) + "-" + std::to_string(temporaries++))).string();
    slot_ = keepName(temporary_);  // Before the file is there, so that it never is without.
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) break;
    const int error = errno;
    releaseName(slot_);
    temporary_.clear();
    if (error != EEXIST) fail(error);
  }
}

WholeFile::~WholeFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  releaseName(slot_);
}

void WholeFile::fail(int error) {
  error_ = error;
  throw InputError(file_ + ": cannot write: " + std::strerror(error));
}

void WholeFile::write(const void* bytes, std::size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(descriptor_, next, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    next += written;
    count -= static_cast<std::size_t>(written);
    position_ += static_cast<uint64_t>(written);
  }
}

void WholeFile::seek(uint64_t position) {
  if (position == position_) return;
  if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) fail(errno);
  position_ = position;
}

void WholeFile::commit() {
  if (error_) fail(error_);
  if (!temporary_.empty() && ::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOSYS) fail(errno);
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0 && errno != EINTR) fail(errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  releaseName(slot_);
  temporary_.clear();
}

void writeWholeFile(const std::string& file, std::string_view text) {
  WholeFile whole(file);
  whole.write(text);
  whole.commit();
}

void removeTemporaryFiles() noexcept {
  for (const Slot& slot : slots)
    if (slot.ready) ::unlink(slot.name);
}

}  // namespace copse
