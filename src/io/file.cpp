#include "io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace lightband::io {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what, int error) {
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

// A new empty file beside path; removed when it goes out of scope, unless it has replaced path.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& path) : path_(path), descriptor_(create()) {}
    ~TemporaryFile() {
        if (!kept_) ::unlink(name_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(const std::vector<uint8_t>& bytes) {
        size_t written = 0;
        while (written < bytes.size()) {
            const ssize_t count = ::write(descriptor_.number(), bytes.data() + written, bytes.size() - written);
            if (count < 0 && errno != EINTR) fail(path_, "cannot be written", errno);
            if (count > 0) written += size_t(count);
        }
        if (const int error = descriptor_.close()) fail(path_, "cannot be written", error);
    }

    void replace_path() {
        if (std::rename(name_.c_str(), path_.c_str()) != 0) fail(path_, "cannot be replaced", errno);
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
            if (errno != EEXIST) fail(path_, "its folder takes no new file", errno);
        }
    }

    std::string path_;
    std::string name_;
    Descriptor descriptor_;
    bool kept_ = false;
};

}  // namespace

std::vector<uint8_t> read_file(const std::string& path, uint64_t limit) {
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.number() < 0) fail(path, "cannot be opened", errno);
    struct stat status;
    if (::fstat(file.number(), &status) != 0) fail(path, "cannot be read", errno);
    const uint64_t announced = S_ISREG(status.st_mode) ? uint64_t(status.st_size) : 0;
    if (announced > limit)
        throw Error(LB_ERROR_FORMAT, text(path, ": ", announced, " bytes exceed the limit of ", limit, " bytes"));

    // Read until the end is seen, one byte beyond the announced size: a pipe announces nothing, a file may grow.
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
    if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
        throw Error(LB_ERROR_FILE, text(path, ": is a folder or a device, not a file that can be replaced"));
    TemporaryFile file(path);
    file.write(bytes);
    file.replace_path();
}

}  // namespace lightband::io
