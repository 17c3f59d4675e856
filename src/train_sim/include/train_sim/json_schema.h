#pragma once

#include <string>

#include "train_dynamics/config/configuration_keys.h"

namespace train_sim {

/// The JSON schema (draft 7) of a kind of configuration file, for editors: which keys there are, of which type, within
/// which bounds, with which others, and what they mean.
///
/// Parts refer to the schemas of their kinds, NAME.schema.json beside it. What the schema leaves out: rules between
/// values, whether files exist, and, where a file has a `base`, whether all is given.
std::string JsonSchema(const train_dynamics::config::FileKind& kind);

}  // namespace train_sim
