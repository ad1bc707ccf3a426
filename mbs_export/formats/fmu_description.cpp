#include "mbs_export/formats/fmu_description.hpp"

#include <fmt/format.h>

#include <array>

namespace chladni::mbs_export::formats {
namespace {

using Kind = FmuVariable::Kind;

/// A text as the value of an attribute of XML.
std::string attribute(const std::string& text)
{
  std::string escaped;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20)
      escaped += ' ';
    else if (c == '&' || c == '<' || c == '>' || c == '"')
      escaped += fmt::format("&#{};", code);
    else
      escaped += c;
  }
  return escaped;
}

const char* units =
    "  <UnitDefinitions>\n"
    "    <Unit name=\"s\"><BaseUnit s=\"1\"/></Unit>\n"
    "    <Unit name=\"N\"><BaseUnit kg=\"1\" m=\"1\" s=\"-2\"/></Unit>\n"
    "    <Unit name=\"N.m\"><BaseUnit kg=\"1\" m=\"2\" s=\"-2\"/></Unit>\n"
    "    <Unit name=\"m\"><BaseUnit m=\"1\"/></Unit>\n"
    "    <Unit name=\"m/s\"><BaseUnit m=\"1\" s=\"-1\"/></Unit>\n"
    "    <Unit name=\"m/s2\"><BaseUnit m=\"1\" s=\"-2\"/></Unit>\n"
    "    <Unit name=\"rad\"><BaseUnit rad=\"1\"/></Unit>\n"
    "    <Unit name=\"rad/s\"><BaseUnit rad=\"1\" s=\"-1\"/></Unit>\n"
    "    <Unit name=\"rad/s2\"><BaseUnit rad=\"1\" s=\"-2\"/></Unit>\n"
    "  </UnitDefinitions>\n";

const char* causality(Kind kind)
{
  switch (kind) {
    case Kind::independent:
      return "independent";
    case Kind::parameter:
      return "parameter";
    case Kind::input:
      return "input";
    case Kind::output:
      return "output";
    default:
      return "local";
  }
}

/// ` initial="..."`, where the kind has one.
const char* initial(Kind kind)
{
  if (kind == Kind::independent || kind == Kind::input) return "";
  const bool is_computed = kind == Kind::output || kind == Kind::derivative;
  return is_computed ? " initial=\"calculated\"" : " initial=\"exact\"";
}

bool has_start(Kind kind)
{
  return kind == Kind::parameter || kind == Kind::input || kind == Kind::state;
}

/// In FMI 2 variables are counted from 1, in FMI 3 told by their value references.
class Writer {
 public:
  Writer(const std::vector<FmuVariable>& variables, FmiVersion version)
      : variables_(variables), version_(version)
  {}

  std::string model_variables() const
  {
    std::string text = "  <ModelVariables>\n";
    for (std::size_t i = 0; i < variables_.size(); ++i) text += variable(i);
    return text + "  </ModelVariables>\n";
  }

  std::string model_structure() const
  {
    const auto is_output = [](const FmuVariable& v) { return v.kind == Kind::output; };
    const auto is_derivative = [](const FmuVariable& v) { return v.kind == Kind::derivative; };
    const auto is_computed = [&](const FmuVariable& v) { return is_output(v) || is_derivative(v); };
    return "  <ModelStructure>\n" + list("Outputs", "Output", is_output) +
           list("Derivatives", "ContinuousStateDerivative", is_derivative) +
           list("InitialUnknowns", "InitialUnknown", is_computed) + "  </ModelStructure>\n";
  }

 private:
  bool is_v2() const { return version_ == FmiVersion::v2; }
  std::size_t number(std::size_t reference) const { return reference + (is_v2() ? 1 : 0); }

  std::string variable(std::size_t reference) const
  {
    const FmuVariable& variable = variables_[reference];
    const std::string common = fmt::format(
        "name=\"{}\" valueReference=\"{}\" description=\"{}\" causality=\"{}\" "
        "variability=\"{}\"{}",
        attribute(variable.name), reference, attribute(variable.description),
        causality(variable.kind), variable.kind == Kind::parameter ? "tunable" : "continuous",
        initial(variable.kind));
    std::string real;
    if (!variable.unit.empty()) real += fmt::format(" unit=\"{}\"", variable.unit);
    if (has_start(variable.kind)) real += fmt::format(" start=\"{}\"", variable.start);
    if (variable.kind == Kind::derivative)
      real += fmt::format(" derivative=\"{}\"", number(variable.derivative_of));
    if (!is_v2()) return fmt::format("    <Float64 {}{}/>\n", common, real);
    return fmt::format("    <ScalarVariable {}><Real{}/></ScalarVariable>\n", common, real);
  }

  std::string unknown(const char* name, std::size_t reference) const
  {
    const FmuVariable& variable = variables_[reference];
    std::string text = fmt::format("    <{} {}=\"{}\"", is_v2() ? "Unknown" : name,
                                   is_v2() ? "index" : "valueReference", number(reference));
    if (!variable.depends_on_all) {
      std::string places;
      for (const std::uint32_t state : variable.depends_on)
        places += fmt::format("{}{}", places.empty() ? "" : " ", number(state));
      text += fmt::format(" dependencies=\"{}\"", places);
    }
    return text + "/>\n";
  }

  std::string list(const char* in_v2, const char* in_v3, auto&& is_of_it) const
  {
    std::string text;
    for (std::size_t i = 0; i < variables_.size(); ++i)
      if (is_of_it(variables_[i])) text += unknown(in_v3, i);
    return is_v2() ? fmt::format("    <{0}>\n{1}    </{0}>\n", in_v2, text) : text;
  }

  const std::vector<FmuVariable>& variables_;
  FmiVersion version_;
};

std::string interfaces(const FmuDescription& of, FmiVersion version)
{
  if (version == FmiVersion::v2) {
    return fmt::format(
        "  <ModelExchange modelIdentifier=\"{0}\" completedIntegratorStepNotNeeded=\"true\" "
        "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" "
        "canSerializeFMUstate=\"true\" "
        "providesDirectionalDerivative=\"{1}\"/>\n"
        "  <CoSimulation modelIdentifier=\"{0}\" canHandleVariableCommunicationStepSize=\"true\" "
        "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" "
        "canSerializeFMUstate=\"true\" "
        "providesDirectionalDerivative=\"{1}\"/>\n",
        of.identifier, of.has_directional_derivatives);
  }
  return fmt::format(
      "  <ModelExchange modelIdentifier=\"{0}\" canGetAndSetFMUState=\"true\" "
      "canSerializeFMUState=\"true\" "
      "providesDirectionalDerivatives=\"{1}\"/>\n"
      "  <CoSimulation modelIdentifier=\"{0}\" canGetAndSetFMUState=\"true\" "
      "canSerializeFMUState=\"true\" "
      "canHandleVariableCommunicationStepSize=\"true\" providesDirectionalDerivatives=\"{1}\"/>\n",
      of.identifier, of.has_directional_derivatives);
}

}  // namespace

std::string fmu_description(const std::vector<FmuVariable>& variables,
                            const FmuDescription& description, FmiVersion version)
{
  const bool is_v2 = version == FmiVersion::v2;
  const Writer writer(variables, version);
  return fmt::format(
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
             "<fmiModelDescription fmiVersion=\"{}\" modelName=\"{}\" {}=\"{}\" "
             "generationTool=\"Chladni\" variableNamingConvention=\"structured\"{}>\n",
             is_v2 ? "2.0" : "3.0", attribute(description.name),
             is_v2 ? "guid" : "instantiationToken", description.token,
             is_v2 ? " numberOfEventIndicators=\"0\"" : "") +
         interfaces(description, version) + units +
         "  <LogCategories>\n    <Category name=\"logStatusError\"/>\n  </LogCategories>\n" +
         writer.model_variables() + writer.model_structure() + "</fmiModelDescription>\n";
}

}  // namespace chladni::mbs_export::formats
