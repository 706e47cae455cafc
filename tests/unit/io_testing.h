// What the tests of src/io share: CMocka, expected errors, a scratch folder, damaged copies of a file.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"

extern "C" {
// clang-format off
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
// clang-format on
}

namespace lightband::testing {

using Bytes = std::vector<uint8_t>;

// Expects call to throw Error(code) with a message that holds each of the words.
template <typename Call>
void expect_error(lb_result code, const std::vector<std::string>& words, const Call& call) {
    lb_result found = LB_OK;
    std::string message;
    try {
        call();
    } catch (const Error& error) {
        found = error.code();
        message = error.what();
    }
    if (found != code) fail_msg("expected result %d, found %d: %s", code, found, message.c_str());
    for (const std::string& word : words)
        if (message.find(word) == std::string::npos)
            fail_msg("'%s' is not in the message '%s'", word.c_str(), message.c_str());
}

// A new empty folder, removed with all it holds.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "lightband-test-XXXXXX").string();
        if (!mkdtemp(name.data())) fail_msg("no scratch folder can be made");
        path_ = name;
    }
    ~ScratchFolder() { std::filesystem::remove_all(path_); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }

    size_t entries() const {
        size_t count = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++count;
        return count;
    }

private:
    std::filesystem::path path_;
};

// Expects LB_ERROR_FORMAT for the prefixes of 0, step, 2 * step ... bytes and for all but the last byte.
template <typename Parse>
void expect_truncation_is_an_error(const Bytes& whole, size_t step, const Parse& parse) {
    for (size_t size = 0; size < whole.size(); size += step)
        expect_error(LB_ERROR_FORMAT, {}, [&] { parse(Bytes(whole.begin(), whole.begin() + size)); });
    expect_error(LB_ERROR_FORMAT, {}, [&] { parse(Bytes(whole.begin(), whole.end() - 1)); });
}

// Parses copies of whole in which up to eight random bits are flipped. Each gives a picture, Error or, where the damage
// asks for much memory, std::bad_alloc. Returns how many were refused.
template <typename Parse>
size_t parse_damaged_copies(const Bytes& whole, size_t copies, const Parse& parse) {
    size_t refused = 0;
    for (size_t copy = 0; copy < copies; ++copy) {
        std::mt19937 random{uint32_t(copy)};
        Bytes damaged = whole;
        const size_t flips = 1 + random() % 8;
        for (size_t i = 0; i < flips; ++i) damaged[random() % damaged.size()] ^= uint8_t(1u << random() % 8);
        try {
            parse(damaged);
        } catch (const Error&) {
            ++refused;
        } catch (const std::bad_alloc&) {
            ++refused;
        }
    }
    return refused;
}

}  // namespace lightband::testing
