#include "squeal/motion/state_archive.hpp"

#include "common/error.hpp"

namespace chladni::squeal {

void StateArchive::one(std::int64_t& x)
{
  if (!gives_) return words_.push_back(x);
  if (next_ == words_.size()) misfit();
  x = words_[next_++];
}

void StateArchive::one(double& x)
{
  auto word = std::bit_cast<std::int64_t>(x);
  one(word);
  x = std::bit_cast<double>(word);
}

void StateArchive::misfit()
{
  throw Error(
      "the state of the interrupted run does not fit this run; begin anew without --resume");
}

void StateArchive::expect_end() const
{
  if (next_ != words_.size()) misfit();
}

std::size_t StateArchive::size(std::size_t now)
{
  auto word = static_cast<std::int64_t>(now);
  one(word);
  const std::size_t left = words_.size() - next_;
  if (gives_ && (word < 0 || static_cast<std::size_t>(word) > left)) misfit();
  return static_cast<std::size_t>(word);
}

}  // namespace chladni::squeal
