#include "cases/runner/table_inputs.hpp"

#include "geometry/base/file_content.hpp"
#include "geometry/base/parameters/parameter_words.hpp"

namespace cutterflow::cases {

namespace {

/// What a table of an array is called in messages: its name, its pair, or its number.
std::string member_name(const ParameterValues& member, const std::string& array, std::size_t number) {
    if (member.has(array + ".name")) return member.text(array + ".name");
    if (member.has(array + ".pair")) return member.texts(array + ".pair")[0] + "-" + member.texts(array + ".pair")[1];
    return std::to_string(number);
}

class Collector {
public:
    Collector(const ParameterTable& table, const std::function<bool(const Parameter&)>& counts) : table_(table), counts_(counts) {}

    /// \param prefix  of the names, in the place of `array`
    void add(const ParameterValues& values, const std::string& array, const std::string& prefix) {
        for (const Parameter& parameter : table_) {
            if (parameter_words::enclosing_array(table_, parameter.key) != array || !values.has(parameter.key) || !counts_(parameter))
                continue;
            const bool is_file = parameter.kind == ParameterKind::path;
            inputs[prefix + parameter.key.substr(array.size())] =
                is_file ? sha256_of_file(values.text(parameter.key)) : toml_text(*values.find(parameter.key));
        }
        for (const std::string& inner : repeated_sections(table_, array)) {
            std::size_t number = 0;
            for (const ParameterValues& member : values.tables(inner))
                add(member, inner, prefix + inner.substr(array.size()) + "." + member_name(member, inner, ++number));
        }
    }

    std::map<std::string, std::string> inputs;

private:
    const ParameterTable& table_;
    const std::function<bool(const Parameter&)>& counts_;
};

}  // namespace

std::map<std::string, std::string> table_inputs(const ParameterTable& table, const ParameterValues& values,
                                                const std::function<bool(const Parameter&)>& counts) {
    Collector collector(table, counts);
    collector.add(values, "", "");
    return std::move(collector.inputs);
}

}  // namespace cutterflow::cases
