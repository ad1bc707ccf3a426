#pragma once

// What the compiler reads once for all sources (chladni_compile in cmake/ChladniTargets.cmake): the
// standard headers and Eigen's that many use, and the products that replace Eigen's. No source
// relies on it for a name: each includes what it uses.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <ranges>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "linear/dense/products.hpp"
