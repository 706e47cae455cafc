// OpenEXR's streams over bytes in memory.
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace lightband::io {

// OpenEXR then codes on the calling thread.
constexpr int no_threads = 0;

class BytesIn : public Imf::IStream {
public:
    BytesIn(const std::vector<uint8_t>& bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}

    bool read(char* out, int count) override {
        if (count < 0 || position_ > bytes_.size() || bytes_.size() - position_ < uint64_t(count))
            throw std::runtime_error("the file ends early");
        if (count > 0) std::memcpy(out, bytes_.data() + position_, size_t(count));
        position_ += uint64_t(count);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

private:
    const std::vector<uint8_t>& bytes_;
    uint64_t position_ = 0;
};

class BytesOut : public Imf::OStream {
public:
    explicit BytesOut(const std::string& name) : OStream(name.c_str()) {}

    void write(const char* data, int count) override {
        const size_t end = position_ + size_t(count);
        if (bytes_.size() < end) bytes_.resize(end);
        std::memcpy(bytes_.data() + position_, data, size_t(count));
        position_ = end;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    const std::vector<uint8_t>& bytes() const { return bytes_; }

private:
    std::vector<uint8_t> bytes_;
    size_t position_ = 0;
};

}  // namespace lightband::io
