// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace oca::loading {

/// What ports of a file itself begin with in connections.
inline constexpr std::string_view kInputs = "inputs.";
inline constexpr std::string_view kOutputs = "outputs.";

/// Whether a port has a place for a name in it, `<arm>.links`.
bool IsPattern(const std::string& port);

/// Whether what its places stand for is not plain: between two of them there is no character that
/// cannot be in a name, such as a dot.
bool IsAmbiguous(const std::string& port);

/// All connections that a pattern stands for: `<arm>.links -> <other>.links_<arm>` makes one of
/// `left.links -> right.links_left` and one of `right.links -> left.links_right` if `outputs` and
/// `inputs` have these. `<x>` is the same name, of letters, digits and underscores, wherever it
/// stands, and another than `<y>`. Neither port is ambiguous. What begins with kInputs or kOutputs
/// is not looked up.
std::vector<std::pair<std::string, std::string>> MatchConnections(
    const std::string& from, const std::string& to, const std::vector<std::string>& outputs,
    const std::vector<std::string>& inputs);

}  // namespace oca::loading
