// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// libFuzzer's entry: the first byte chooses the parser, the rest is its text. Aborts if a parser
/// accepts what it could not write back, or refuses without a one-line message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace xtrack::fuzz {

inline constexpr std::uint8_t kParsers = 8;

}  // namespace xtrack::fuzz
