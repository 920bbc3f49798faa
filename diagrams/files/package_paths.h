// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace oca::files {

/// Folders of packages, by name.
using PackageMap = std::map<std::string, std::filesystem::path>;

/// A text that tells the folders from others.
std::string FormOf(const PackageMap& packages);

/// Folders that hold packages when a file does not say: OCA_PACKAGE_PATH, then the robots and
/// worlds that come with OCA.
std::vector<std::filesystem::path> PackageFolders();

/// `name` as a path: `package://NAME/REST` looked up in `packages`, then in PackageFolders(), once
/// while a models::FileCache is in use; a relative path from `folder`, without `..` that only
/// lead back. `package://oca` is the folder of the diagrams that come with OCA, if no other has
/// that name.
/// throws ConfigError naming the places where the package was looked for.
std::filesystem::path ResolvePath(const std::string& name, const std::filesystem::path& folder,
                                  const PackageMap& packages);

/// How a package that is nowhere is made known, for the end of a message.
inline constexpr char kPackageAdvice[] =
    "; OCA_PACKAGE_PATH=FOLDER, or packages of a diagram, say where others are";

/// The folder of a package in one of PackageFolders(); empty if there is none.
std::filesystem::path KnownPackage(const std::string& package);
/// The same, else the folder of that name that `file` lies in, or that lies beside it or beside a
/// folder above: what every command takes for a package of the robot in `file`.
std::filesystem::path PackageFor(const std::filesystem::path& file, const std::string& package);

/// Whether a diagram file is one of the parts that come with OCA, by its name and content, wherever
/// it lies.
bool IsPartOfOca(const std::filesystem::path& file);

}  // namespace oca::files
