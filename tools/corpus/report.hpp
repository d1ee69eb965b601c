// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/corpus/run.hpp"

namespace xtrack::tools::corpus {

/// What was asked of some sequences.
enum class Part : std::uint8_t {
    gestures,    ///< people who gesture as usual
    manners,     ///< people who move differently
    everyday,    ///< movement that is none, of whoever has the session
    engaged,     ///< the same where it takes a session, by hours with one
    passers_by,  ///< the same of those who have not
    company,     ///< strangers about one who has
    images,      ///< fringe images through the whole pipeline
};
inline constexpr std::size_t kPartCount = 6;
/// As --only takes it.
[[nodiscard]] const char* to_string(Part part) noexcept;

/// One line of sets, views, manners or scenes that belong together.
struct Group {
    Part part = Part::gestures;
    std::string name;
    Tally tally;
};

[[nodiscard]] std::string text_of(const std::vector<Group>& groups, bool explain);
[[nodiscard]] nlohmann::ordered_json json_of(const std::vector<Group>& groups);

}  // namespace xtrack::tools::corpus
