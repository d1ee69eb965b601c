// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core/persistence.hpp>

#include <xtrack/geometry.hpp>
#include <xtrack/result.hpp>

namespace xtrack::capture {

/// Refuses what FileStorage cannot be trusted with: no `%YAML` line, NUL bytes, over 16 brackets or
/// list dashes deep, over kMaxYamlBytes long.
[[nodiscard]] Result<void> check_yaml_text(const std::string& text, const std::string& name);

/// One level of a YAML file; every member names file and field in its messages.
class YamlMap {
 public:
    /// @param prefix of field names in messages, such as "sequence[3]."
    YamlMap(const cv::FileNode& node, std::string name, std::string prefix = {});

    [[nodiscard]] bool has(const char* key) const;
    [[nodiscard]] Result<double> number(const char* key) const;
    [[nodiscard]] Result<int> integer(const char* key) const;
    /// 0, 1, true or false.
    [[nodiscard]] Result<bool> flag(const char* key) const;
    [[nodiscard]] Result<std::string> word(const char* key) const;
    [[nodiscard]] Result<Size> size(const char* key) const;
    /// A matrix or a list of numbers, row by row, between `least` and `most` of them. A matrix must
    /// have as many as its rows and columns say, and one channel.
    [[nodiscard]] Result<std::vector<double>> numbers(const char* key, std::size_t least,
                                                      std::size_t most) const;
    /// The same of a matrix of this shape, lying down or upright where it is a vector, or a list.
    [[nodiscard]] Result<std::vector<double>> matrix(const char* key, int rows, int cols) const;
    /// The entries of a list of maps.
    [[nodiscard]] Result<std::vector<YamlMap>> maps(const char* key, std::size_t most) const;

    [[nodiscard]] Error error(const char* key, const std::string& what) const;

 private:
    [[nodiscard]] Result<cv::FileNode> find(const char* key) const;
    [[nodiscard]] Result<void> check_matrix_head(const char* key, const cv::FileNode& matrix) const;

    cv::FileNode node_;
    std::string name_;
    std::string prefix_;
};

}  // namespace xtrack::capture
