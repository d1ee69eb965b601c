// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <xtrack/result.hpp>

namespace xtrack::base {

/// The whole file, refused if it is longer than `max_bytes`, is not a plain file, or is not there.
/// Messages name the file.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::size_t max_bytes);

/// The first `bytes` bytes of a file, fewer where it is shorter. Messages name the file.
[[nodiscard]] Result<std::string> read_start(const std::filesystem::path& path, std::size_t bytes);

/// Writes a file so that it is there whole or not at all: into a temporary one beside it, which
/// then takes the name. An existing file is replaced. Who may read it is the umask's business.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

/// A folder that appears whole or not at all: filled under a temporary name beside its target, and
/// given its name by commit(). Without a commit() the destructor removes it.
/// @thread one at a time
class NewFolder {
 public:
    /// @return an Error if the target is there and is anything but an empty folder, or its parent
    /// is
    ///         missing or not writable
    [[nodiscard]] static Result<NewFolder> create(const std::filesystem::path& target);

    NewFolder(NewFolder&& other) noexcept;
    NewFolder& operator=(NewFolder&& other) noexcept;
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;
    ~NewFolder();

    /// Where to put files until commit().
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return temporary_; }
    [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }

    // A name that does not stay inside (stays_inside()) is refused by both.
    /// Makes a folder inside, with those that it lies in.
    [[nodiscard]] Result<void> make_folder(const std::filesystem::path& inside) const;
    /// Adds to the end of a file inside, which is made where there is none: all of the bytes, or,
    /// as far as the system lets it, none of them.
    [[nodiscard]] Result<void> append(const std::filesystem::path& inside,
                                      std::string_view bytes) const;
    /// Writes a file inside, which is there whole or not at all, and replaces an older one.
    [[nodiscard]] Result<void> write(const std::filesystem::path& inside,
                                     std::string_view bytes) const;
    /// Gives the folder its name. @return an Error if something has appeared there meanwhile, which
    /// stays untouched; the folder is then removed.
    [[nodiscard]] Result<void> commit();
    /// Removes what was written so far. Cannot fail.
    void discard() noexcept;

 private:
    NewFolder() = default;

    std::filesystem::path target_;
    std::filesystem::path temporary_;  // empty once committed or discarded
};

/// True if `text` names something inside a folder: relative, no root, no drive, no "..", no control
/// character, not empty. It judges the name alone: links on the disk are followed.
/// `/` and `\` both part names, so that a recording means the same on every system.
[[nodiscard]] bool stays_inside(std::string_view text) noexcept;

}  // namespace xtrack::base
