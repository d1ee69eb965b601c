// SPDX-License-Identifier: Apache-2.0
#include "core/base/file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <random>
#include <system_error>
#include <utility>

#include "core/base/text.hpp"

namespace xtrack::base {

namespace fs = std::filesystem;

namespace {

constexpr int kTemporaryNameTries = 16;

Error io_error(const fs::path& path, const std::string& what) {
    return {ErrorCode::io, path.string() + ": " + what};
}

// A name nobody else uses, beside the target so that the last rename stays on one file system. It
// cannot be foretold, so that nobody can put a link there first in a folder that others may write.
fs::path temporary_beside(const fs::path& target) {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::random_device random;
    std::string name = "." + target.filename().string() + ".";
    for (int i = 0; i < 8; ++i) {
        name += kDigits[random() % 16U];
    }
    return target.parent_path() / (name + ".part");
}

// "out/" and "out" are the same folder.
fs::path without_trailing_slash(const fs::path& path) {
    return path.has_filename() ? path : path.parent_path();
}

Result<void> check_inside(const fs::path& target, const fs::path& inside) {
    if (!stays_inside(inside.string())) {
        return Error{ErrorCode::invalid_argument,
                     target.string() + ": " + base::quoted(inside.string()) +
                         " names nothing inside the folder; give a relative name without '..'"};
    }
    return {};
}

Result<void> write_plainly(const fs::path& path, std::string_view bytes) {
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
        return io_error(
            path, "cannot be written; is its folder there and writable, and the disk not full?");
    }
    return {};
}

}  // namespace

Result<std::string> read_file(const fs::path& path, std::size_t max_bytes) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) {
        return Error{ErrorCode::not_found, path.string() + ": is not there; check the path"};
    }
    // A device or a pipe has no end that one could trust.
    if (!fs::is_regular_file(status)) {
        return io_error(path, "is not a file; give a plain file");
    }
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) {
        return io_error(path, "cannot be read; check its permissions");
    }
    if (size > max_bytes) {
        return Error{ErrorCode::malformed, path.string() + ": is " + std::to_string(size) +
                                               " bytes long; at most " + std::to_string(max_bytes) +
                                               " are read, shorten or split it"};
    }
    std::ifstream in(path, std::ios::binary);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!in && size != 0) {
        return io_error(path, "cannot be read; check its permissions");
    }
    return bytes;
}

Result<std::string> read_start(const fs::path& path, std::size_t bytes) {
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) {
        const std::error_code why(errno, std::generic_category());
        return io_error(path, "cannot be opened" + (why ? ": " + why.message() : std::string()) +
                                  "; check the path and its permissions");
    }
    std::string start(bytes, '\0');
    in.read(start.data(), static_cast<std::streamsize>(bytes));
    if (in.bad()) {
        return io_error(path, "cannot be read; is the disk in order?");
    }
    start.resize(static_cast<std::size_t>(in.gcount()));
    return start;
}

Result<void> write_file(const fs::path& path, std::string_view bytes) {
    const fs::path temporary = temporary_beside(path);
    std::error_code error;
    if (auto ok = write_plainly(temporary, bytes); !ok) {
        fs::remove(temporary, error);
        return io_error(
            path, "cannot be written; is its folder there and writable, and the disk not full?");
    }
    fs::rename(temporary, path, error);
    if (error) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        return io_error(path, "cannot be replaced; " + error.message());
    }
    return {};
}

Result<NewFolder> NewFolder::create(const fs::path& target) {
    NewFolder folder;
    folder.target_ = without_trailing_slash(target);
    std::error_code error;
    if (folder.target_.empty()) {
        return Error{ErrorCode::invalid_argument, "the name of the new folder is empty; give one"};
    }
    const fs::file_status status = fs::symlink_status(folder.target_, error);
    if (fs::exists(status) && !(fs::is_directory(status) && fs::is_empty(folder.target_, error))) {
        return Error{ErrorCode::invalid_argument,
                     target.string() + ": exists already; remove it or give another name"};
    }
    const fs::path parent = folder.target_.parent_path();
    if (!parent.empty() && !fs::is_directory(parent, error)) {
        return Error{ErrorCode::not_found,
                     target.string() + ": its parent folder is missing; make it first"};
    }
    for (int i = 0; i < kTemporaryNameTries; ++i) {
        const fs::path temporary = temporary_beside(folder.target_);
        if (fs::create_directory(temporary, error)) {
            folder.temporary_ = temporary;
            return folder;
        }
        if (error) {
            break;
        }
    }
    return io_error(target, "cannot be made; is its parent folder writable?");
}

NewFolder::NewFolder(NewFolder&& other) noexcept { *this = std::move(other); }

NewFolder& NewFolder::operator=(NewFolder&& other) noexcept {
    if (this != &other) {
        discard();
        target_ = std::exchange(other.target_, {});
        temporary_ = std::exchange(other.temporary_, {});
    }
    return *this;
}

NewFolder::~NewFolder() { discard(); }

Result<void> NewFolder::make_folder(const fs::path& inside) const {
    if (auto ok = check_inside(target_, inside); !ok) {
        return ok;
    }
    std::error_code error;
    fs::create_directories(temporary_ / inside, error);
    if (error) {
        return io_error(target_ / inside, "cannot be made; " + error.message());
    }
    return {};
}

Result<void> NewFolder::write(const fs::path& inside, std::string_view bytes) const {
    if (auto ok = check_inside(target_, inside); !ok) {
        return ok;
    }
    if (!write_file(temporary_ / inside, bytes)) {
        return io_error(target_ / inside, "cannot be written; is the disk full?");
    }
    return {};
}

Result<void> NewFolder::append(const fs::path& inside, std::string_view bytes) const {
    if (auto ok = check_inside(target_, inside); !ok) {
        return ok;
    }
    const fs::path file = temporary_ / inside;
    std::error_code error;
    const std::uintmax_t before = fs::exists(file, error) ? fs::file_size(file, error) : 0;
    std::ofstream out(file, std::ios::binary | std::ios::app);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
        fs::resize_file(file, before, error);  // half a line would spoil those before it
        return io_error(target_ / inside, "cannot be written; is the disk full?");
    }
    return {};
}

Result<void> NewFolder::commit() {
    // Onto nothing or an empty folder, in one step; the system refuses any other target, so that
    // what has appeared there meanwhile is safe.
    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) {
        discard();
        return io_error(target_, "cannot be made; " + error.message() +
                                     "; remove what is there or give another name");
    }
    temporary_.clear();
    return {};
}

void NewFolder::discard() noexcept {
    if (temporary_.empty()) {
        return;
    }
    std::error_code ignored;
    fs::remove_all(temporary_, ignored);
    temporary_.clear();
}

bool stays_inside(std::string_view text) noexcept {
    if (text.empty() || text.find(':') != std::string_view::npos) {  // C:file, file:stream
        return false;
    }
    // Names come back in messages, where a control character would speak to the terminal.
    const auto is_control = [](char c) {
        return static_cast<unsigned char>(c) < 0x20U || c == 0x7F;
    };
    if (std::any_of(text.begin(), text.end(), is_control)) {
        return false;
    }
    while (true) {
        const std::size_t slash = text.find_first_of("/\\");
        const std::string_view part = text.substr(0, slash);
        if (part.empty() || part == "..") {  // a leading, double or last slash is no name either
            return false;
        }
        if (slash == std::string_view::npos) {
            return true;
        }
        text.remove_prefix(slash + 1);
    }
}

}  // namespace xtrack::base
