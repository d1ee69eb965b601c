// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include <xtrack/result.hpp>

namespace xtrack::capture {

/// Decoders and trackers know a rig and patterns, not where these came from: names the file.
inline Error in_recording(const std::filesystem::path& folder, const Error& error) {
    struct Source {
        std::string_view begin;
        const char* file;
    };
    for (const auto& [begin, file] :
         {Source{"rig: ", "rig.yaml"}, Source{"pattern sequence: ", "pattern.yaml"}}) {
        if (error.message.starts_with(begin)) {
            return {error.code,
                    (folder / file).string() + ": " + error.message.substr(begin.size())};
        }
    }
    return {error.code, folder.string() + ": " + error.message};
}

}  // namespace xtrack::capture
