#pragma once

#include "strict_config/parameters.h"

/// The words of strict_config in which the parameter structs of the physics describe themselves.
namespace train_dynamics {

using strict_config::Choices;
using strict_config::Keys;
using strict_config::kFinite;
using strict_config::kFraction;
using strict_config::kNonNegative;
using strict_config::kPositive;
using strict_config::kRequired;
using strict_config::kRequiredInteger;
using strict_config::Range;
using strict_config::ShortestDecimal;

}  // namespace train_dynamics
