// SPDX-License-Identifier: Apache-2.0
// The xtrack command as a user meets it: arguments in; exit status, stdout and stderr out.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace xtrack::test {

struct Outcome {
    int status = -1;  ///< as a shell says it: 128 + the signal that ended it
    std::string out;
    std::string err;
};

/// Runs `xtrack <arguments>` in an empty folder of its own and waits for it.
/// @param out where its stdout goes; `Outcome::out` is empty where that is outside the folder
Outcome xtrack_command(const std::vector<std::string>& arguments, const char* out = "stdout");

/// The same, with `signal` sent once `ready` says so of what is on stdout, or after `patience` in
/// any case. @param in what is its stdin
Outcome interrupted_command(const std::vector<std::string>& arguments, int signal,
                            const std::function<bool(const std::string& out)>& ready,
                            std::chrono::milliseconds patience = std::chrono::seconds(20),
                            const char* in = "/dev/null");

/// One line that begins with the command's name and ends there.
bool is_one_line_message(const std::string& text);

/// An empty folder, removed with all in it at the end.
class TemporaryFolder {
 public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
    std::filesystem::path path_;
};

std::string text_of(const std::filesystem::path& file);
void set_text(const std::filesystem::path& file, const std::string& text);

}  // namespace xtrack::test
