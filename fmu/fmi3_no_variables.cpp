// Getters and setters of FMI 3.0 for types and clocks that no variable has, by the names of its
// standard.
#include "fmu/fmi3.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "fmu/component.hpp"

// NOLINTBEGIN(readability-identifier-naming)
namespace {

using namespace chladni::fmu;
using namespace chladni::fmu::fmi3;
using chladni::Error;

}  // namespace

extern "C" {

Status fmi3GetFloat32(void* c, const Reference*, std::size_t n, float*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetFloat32(void* c, const Reference*, std::size_t n, const float*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetInt8(void* c, const Reference*, std::size_t n, std::int8_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetInt8(void* c, const Reference*, std::size_t n, const std::int8_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetUInt8(void* c, const Reference*, std::size_t n, std::uint8_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetUInt8(void* c, const Reference*, std::size_t n, const std::uint8_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetInt16(void* c, const Reference*, std::size_t n, std::int16_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetInt16(void* c, const Reference*, std::size_t n, const std::int16_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetUInt16(void* c, const Reference*, std::size_t n, std::uint16_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetUInt16(void* c, const Reference*, std::size_t n, const std::uint16_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetInt32(void* c, const Reference*, std::size_t n, std::int32_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetInt32(void* c, const Reference*, std::size_t n, const std::int32_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetUInt32(void* c, const Reference*, std::size_t n, std::uint32_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetUInt32(void* c, const Reference*, std::size_t n, const std::uint32_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetInt64(void* c, const Reference*, std::size_t n, std::int64_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetInt64(void* c, const Reference*, std::size_t n, const std::int64_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetUInt64(void* c, const Reference*, std::size_t n, std::uint64_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetUInt64(void* c, const Reference*, std::size_t n, const std::uint64_t*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetBoolean(void* c, const Reference*, std::size_t n, bool*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetBoolean(void* c, const Reference*, std::size_t n, const bool*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetString(void* c, const Reference*, std::size_t n, const char**, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetString(void* c, const Reference*, std::size_t n, const char* const*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetBinary(void* c, const Reference*, std::size_t n, std::size_t*, const std::uint8_t**,
                     std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3SetBinary(void* c, const Reference*, std::size_t n, const std::size_t*,
                     const std::uint8_t* const*, std::size_t)
{
  return none_of<Status>(c, n);
}

Status fmi3GetClock(void* c, const Reference*, std::size_t n, bool*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetClock(void* c, const Reference*, std::size_t n, const bool*)
{
  return none_of<Status>(c, n);
}

Status fmi3GetIntervalDecimal(void* c, const Reference*, std::size_t n, double*, IntervalQualifier*)
{
  return none_of<Status>(c, n);
}

Status fmi3GetIntervalFraction(void* c, const Reference*, std::size_t n, std::uint64_t*,
                               std::uint64_t*, IntervalQualifier*)
{
  return none_of<Status>(c, n);
}

Status fmi3GetShiftDecimal(void* c, const Reference*, std::size_t n, double*)
{
  return none_of<Status>(c, n);
}

Status fmi3GetShiftFraction(void* c, const Reference*, std::size_t n, std::uint64_t*,
                            std::uint64_t*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetIntervalDecimal(void* c, const Reference*, std::size_t n, const double*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetIntervalFraction(void* c, const Reference*, std::size_t n, const std::uint64_t*,
                               const std::uint64_t*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetShiftDecimal(void* c, const Reference*, std::size_t n, const double*)
{
  return none_of<Status>(c, n);
}

Status fmi3SetShiftFraction(void* c, const Reference*, std::size_t n, const std::uint64_t*,
                            const std::uint64_t*)
{
  return none_of<Status>(c, n);
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
