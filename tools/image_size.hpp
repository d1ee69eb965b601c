// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <xtrack/geometry.hpp>

namespace xtrack::tools {

/// A size such as `640x480`; nothing where it is none that an image may have.
[[nodiscard]] std::optional<Size> parse_size(const std::string& text);

}  // namespace xtrack::tools
