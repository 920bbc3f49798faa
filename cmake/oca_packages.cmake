# SPDX-License-Identifier: BSD-3-Clause
# Every third-party library, found once. All are Debian 12 packages; nothing is downloaded.
find_package(Eigen3 3.4 REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(SUNDIALS REQUIRED COMPONENTS cvode arkode nvecserial sunmatrixdense sunlinsoldense)
find_package(yaml-cpp REQUIRED)
find_package(muparser REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(Boost 1.74 REQUIRED)  # headers alone: Asio and Beast

# CMake's FindBullet picks the float build without a word, so pkg-config names the double one.
find_package(PkgConfig REQUIRED)
pkg_check_modules(bullet REQUIRED IMPORTED_TARGET bullet-float64)
pkg_check_modules(urdfdom REQUIRED IMPORTED_TARGET urdfdom)
pkg_check_modules(tinyxml REQUIRED IMPORTED_TARGET tinyxml)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET liblz4)
