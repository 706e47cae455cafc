#include "io/file.h"

#include <fcntl.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace lightband::io {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what, int error) {
    if (error == ENOMEM) throw std::bad_alloc();
    // The system's words for an errno; strerror itself is not safe among threads.
    throw Error(LB_ERROR_FILE, text(path, ": ", what, ": ", std::generic_category().message(error)));
}

// A POSIX descriptor, closed when it goes out of scope.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number() const { return number_; }

    // For writers, to whom closing may report the last failure: 0 or the errno.
    int close() { return ::close(std::exchange(number_, -1)) == 0 ? 0 : errno; }

private:
    int number_;
};

const char* kind_of(mode_t mode) {
    if (S_ISDIR(mode)) return "a directory";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

// Where writing to path ends: path itself, or what a symbolic link at its end leads to, over any number of links. The last
// one may lead to a file that does not exist yet.
std::string follow_links(const std::string& path) {
    constexpr int most_links = 40;  // Linux's own limit (path_resolution(7))
    std::string end = path;
    std::vector<char> target(PATH_MAX);
    for (int links = 0; links < most_links; ++links) {
        const ssize_t length = ::readlink(end.c_str(), target.data(), target.size());
        if (length < 0 && errno != EINVAL && errno != ENOENT) fail(path, "cannot be written", errno);
        if (length < 0) return end;
        if (size_t(length) == target.size()) fail(path, "cannot be written", ENAMETOOLONG);
        const std::string next(target.data(), size_t(length));
        const size_t slash = end.rfind('/');
        end = next.front() == '/' || slash == std::string::npos ? next : end.substr(0, slash + 1) + next;
    }
    fail(path, "cannot be written", ELOOP);
}

// A new empty file beside path; removed when it goes out of scope, unless it has replaced path.
class TemporaryFile {
public:
    // shown stands in messages. mode: that of the file that will be replaced.
    TemporaryFile(const std::string& path, const std::string& shown, std::optional<mode_t> mode)
        : path_(path), shown_(shown), descriptor_(create()) {
        // A file system without modes may refuse; the data matter more.
        if (mode) [[maybe_unused]] const int refused = ::fchmod(descriptor_.number(), *mode & 07777);
    }
    ~TemporaryFile() {
        if (!kept_) ::unlink(name_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(const std::vector<uint8_t>& bytes) {
        size_t written = 0;
        while (written < bytes.size()) {
            const ssize_t count = ::write(descriptor_.number(), bytes.data() + written, bytes.size() - written);
            if (count < 0 && errno != EINTR) fail(shown_, "cannot be written", errno);
            if (count > 0) written += size_t(count);
        }
        if (const int error = descriptor_.close()) fail(shown_, "cannot be written", error);
    }

    void replace_path() {
        if (std::rename(name_.c_str(), path_.c_str()) != 0) fail(shown_, "cannot be replaced", errno);
        kept_ = true;
    }

private:
    // Opened with O_EXCL rather than by mkstemp, so that the user's umask decides who may read the file.
    int create() {
        static std::atomic<uint32_t> counter{0};
        const size_t slash = path_.rfind('/');
        const std::string folder = slash == std::string::npos ? std::string() : path_.substr(0, slash + 1);
        for (;;) {
            name_ = folder + ".lightband-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
            const int number = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (number >= 0) return number;
            if (errno != EEXIST) fail(shown_, "its folder takes no new file", errno);
        }
    }

    std::string path_;
    std::string shown_;
    std::string name_;
    Descriptor descriptor_;
    bool kept_ = false;
};

}  // namespace

bool exists(const std::string& path) {
    struct stat status;
    return ::lstat(path.c_str(), &status) == 0;
}

std::vector<uint8_t> read_file(const std::string& path, uint64_t limit) {
    // Without O_NONBLOCK, opening a pipe waits for one who writes to it.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (file.number() < 0) {
        const int reason = errno;
        struct stat status;  // a socket cannot be opened at all
        if (reason == ENXIO && ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
            throw Error(LB_ERROR_FILE, text(path, ": is ", kind_of(status.st_mode), ", not a file that can be read"));
        fail(path, "cannot be opened", reason);
    }
    struct stat status;
    if (::fstat(file.number(), &status) != 0) fail(path, "cannot be read", errno);
    if (!S_ISREG(status.st_mode))
        throw Error(LB_ERROR_FILE, text(path, ": is ", kind_of(status.st_mode), ", not a file that can be read"));
    const uint64_t announced = uint64_t(status.st_size);
    if (announced > limit)
        throw Error(LB_ERROR_FORMAT, text(path, ": ", announced, " bytes exceed the limit of ", limit, " bytes"));

    // Read until the end is seen, one byte beyond the announced size: a file may grow, and those of /proc announce nothing.
    constexpr uint64_t smallest_step = 65536;
    std::vector<uint8_t> bytes;
    size_t used = 0;
    bytes.resize(announced + 1);
    for (;;) {
        const ssize_t count = ::read(file.number(), bytes.data() + used, bytes.size() - used);
        if (count < 0 && errno != EINTR) fail(path, "cannot be read", errno);
        if (count == 0) break;
        if (count > 0) used += size_t(count);
        if (used > limit) throw Error(LB_ERROR_FORMAT, text(path, ": more bytes than the limit of ", limit, " bytes"));
        if (used == bytes.size()) bytes.resize(std::min(limit + 1, used + std::max<uint64_t>(used, smallest_step)));
    }
    bytes.resize(used);
    return bytes;
}

void write_file(const std::string& path, const std::vector<uint8_t>& bytes) {
    // Renaming onto a device or a pipe would put a plain file in its place.
    struct stat status;
    const bool replaces = ::stat(path.c_str(), &status) == 0;
    if (replaces && !S_ISREG(status.st_mode))
        throw Error(LB_ERROR_FILE, text(path, ": is ", kind_of(status.st_mode), ", not a file that can be replaced"));
    TemporaryFile file(follow_links(path), path, replaces ? std::optional<mode_t>(status.st_mode) : std::nullopt);
    file.write(bytes);
    file.replace_path();
}

}  // namespace lightband::io
