#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <initializer_list>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace train_node {

/// The private parameters of a node, read as strictly as a configuration file: a value of another type is an error
/// and not the default, and so is a name that the node does not know.
///
///   NodeParameters parameters(ros::this_node::getName());
///   const bool record = parameters.Flag("record", true);
///   ...
///   parameters.ThrowIfWrong();  // when all have been read
///
/// A value of a wrong type or out of its range is noted and the default is returned, so that all errors are reported at
/// once.
class NodeParameters {
 public:
  /// Reads what the ROS master has under the node's name; needs ros::init, but no registration of the node.
  explicit NodeParameters(const std::string& node);
  /// @param values  a struct of parameters by name; any other type counts as no parameters
  explicit NodeParameters(const XmlRpc::XmlRpcValue& values);

  bool Has(const std::string& name) const;
  std::string Text(const std::string& name, const std::string& fallback);
  /// Words separated by blanks; a single integer is one word.
  std::string Words(const std::string& name);
  bool Flag(const std::string& name, bool fallback);
  int Integer(const std::string& name, int fallback, int least = std::numeric_limits<int>::min());
  /// A finite number >= 0; an integer is one, too.
  double NonNegative(const std::string& name, double fallback);
  /// Whether the parameter is the first of its two words, which is also its default.
  bool IsFirstOf(const std::string& name, const std::string& first, const std::string& second);
  /// One of these words, the first being the default. If `true` and `false` are among them, Boolean values are
  /// accepted, too.
  std::string Choice(const std::string& name, const std::vector<std::string>& words);
  /// All parameters that exist, known to the node or not.
  std::vector<std::string> Names() const;
  /// Notes an error of a parameter that its type does not show.
  void Complain(const std::string& name, const std::string& rule);

  /// @throws std::invalid_argument with one line for each error: "parameter record must be true or false, got 'no'"
  void ThrowIfWrong() const;

 private:
  /// The value if it exists and has that type, or else null after noting the error.
  const XmlRpc::XmlRpcValue* Find(const std::string& name, std::initializer_list<XmlRpc::XmlRpcValue::Type> types,
                                  const char* rule);

  XmlRpc::XmlRpcValue values_;
  std::set<std::string> known_;
  std::vector<std::string> errors_;
};

}  // namespace train_node
