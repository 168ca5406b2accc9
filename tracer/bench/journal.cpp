// Append, fsync; truncate what was not written whole.
#include "tracer/bench/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "builder/base/error.h"

namespace copse {

namespace {

std::optional<Journal::Entry> parse(std::string line) {
  const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("run") || !json["run"].is_object()) return std::nullopt;
  const nlohmann::json& run = json["run"];
  const auto isText = [&](const char* name) { return run.contains(name) && run[name].is_string(); };
  if (!isText("key") || !isText("status") || !run.contains("repetition") || !run["repetition"].is_number_integer())
    return std::nullopt;
  return Journal::Entry{run["key"], std::move(line), run["repetition"], run["status"] == "failed"};
}

}  // namespace

Journal::Journal(const std::string& file) : file_(file) {
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(errno);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const bool other = errno == EWOULDBLOCK;
    ::close(descriptor_);
    if (other) throw InputError(file + ": another process is writing it");
    throw InputError(file + ": cannot lock: " + std::strerror(errno));
  }
  try {
    read();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() { ::close(descriptor_); }

void Journal::fail(int error) { throw InputError(file_ + ": cannot write: " + std::strerror(error)); }

void Journal::read() {
  std::string text;
  char buffer[1 << 16];
  ssize_t got;
  while ((got = ::read(descriptor_, buffer, sizeof buffer)) > 0) text.append(buffer, static_cast<std::size_t>(got));
  if (got < 0) throw InputError(file_ + ": cannot read: " + std::strerror(errno));
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    std::optional<Entry> entry = parse(text.substr(begin, end - begin));
    if (!entry) {
      if (end + 1 == text.size()) break;  // A line whose bytes did not all reach the disk.
      throw InputError(fmt::format("{}:{}: expected the record of a run", file_, entries_.size() + 1));
    }
    entries_.push_back(std::move(*entry));
  }
  size_ = static_cast<long long>(begin);
  if (begin < text.size() && ::ftruncate(descriptor_, size_) != 0) fail(errno);
}

bool Journal::holds(const std::string& key, int repetition) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.repetition == repetition && entry.key == key; });
}

void Journal::append(std::string_view line) {
  std::optional<Entry> entry = parse(std::string(line.substr(0, line.size() - 1)));
  if (!entry || line.back() != '\n') throw InputError(file_ + ": expected a record to append");
  const auto giveUp = [&](int error) {
    [[maybe_unused]] const int cut = ::ftruncate(descriptor_, size_);
    fail(error);
  };
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t written = ::write(descriptor_, line.data() + done, line.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) giveUp(errno);
    done += static_cast<std::size_t>(written);
  }
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOSYS) giveUp(errno);
  size_ += static_cast<long long>(line.size());
  entries_.push_back(std::move(*entry));
}

}  // namespace copse
