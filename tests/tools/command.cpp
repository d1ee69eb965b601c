// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/command.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace xtrack::test {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPoll{20};

pid_t start(const std::vector<std::string>& arguments, const fs::path& folder,
            const char* out = "stdout", const char* in = "/dev/null") {
    std::vector<std::string> words = {XTRACK_COMMAND};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);

    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, in, O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out, O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "stderr", O_WRONLY | O_CREAT, 0600);
    pid_t child = 0;
    const int failed = posix_spawn(&child, XTRACK_COMMAND, &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failed != 0) {
        throw std::runtime_error(std::string(XTRACK_COMMAND) + " does not start");
    }
    return child;
}

Outcome outcome_of(pid_t child, const fs::path& folder) {
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            text_of(folder / "stdout"), text_of(folder / "stderr")};
}

}  // namespace

Outcome xtrack_command(const std::vector<std::string>& arguments, const char* out) {
    const TemporaryFolder folder;
    return outcome_of(start(arguments, folder.path(), out), folder.path());
}

Outcome interrupted_command(const std::vector<std::string>& arguments, int signal,
                            const std::function<bool(const std::string& out)>& ready,
                            std::chrono::milliseconds patience, const char* in) {
    const TemporaryFolder folder;
    const pid_t child = start(arguments, folder.path(), "stdout", in);
    for (auto waited = kPoll; waited < patience; waited += kPoll) {
        std::this_thread::sleep_for(kPoll);
        if (ready(text_of(folder.path() / "stdout"))) {
            break;
        }
    }
    kill(child, signal);
    return outcome_of(child, folder.path());
}

bool is_one_line_message(const std::string& text) {
    return text.starts_with("xtrack: ") && std::count(text.begin(), text.end(), '\n') == 1 &&
           text.back() == '\n';
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "xtrack_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error(name + " cannot be made");
    }
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

void set_text(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

}  // namespace xtrack::test
