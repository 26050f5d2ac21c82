#pragma once
/// \file Declares rows of a ParameterTable in a few words.
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow {

/// A row under construction: ParameterRow("rotor.speed_rpm", ParameterKind::number, "rpm", "Help.").above(0).at_most(600).
class ParameterRow {
public:
    ParameterRow(std::string key, ParameterKind kind, std::string unit, std::string help) {
        parameter_.key = std::move(key);
        parameter_.kind = kind;
        parameter_.unit = std::move(unit);
        parameter_.help = std::move(help);
    }
    explicit ParameterRow(Parameter parameter) : parameter_(std::move(parameter)) {}

    ParameterRow& above(double bound) {
        parameter_.minimum = bound;
        parameter_.minimum_excluded = true;
        return *this;
    }
    ParameterRow& at_least(double bound) {
        parameter_.minimum = bound;
        return *this;
    }
    ParameterRow& at_most(double bound) {
        parameter_.maximum = bound;
        return *this;
    }
    ParameterRow& by_default(ParameterValue value) {
        parameter_.default_value = std::move(value);
        return *this;
    }
    /// May be absent; `rule` says what is used then.
    ParameterRow& derived(std::string rule) {
        parameter_.default_value.reset();
        parameter_.optional = true;
        parameter_.derived_from = std::move(rule);
        return *this;
    }
    ParameterRow& one_of(std::vector<std::string> choices) {
        parameter_.choices = std::move(choices);
        return *this;
    }
    ParameterRow& optional() { return derived(""); }
    /// Of a list.
    ParameterRow& of_length(std::size_t length) {
        parameter_.length = length;
        return *this;
    }
    ParameterRow& repeated() {
        parameter_.repeated = true;
        return *this;
    }
    ParameterRow& source(std::string reference) {
        parameter_.reference = std::move(reference);
        return *this;
    }
    ParameterRow& stage(std::string name) {
        parameter_.stage = std::move(name);
        return *this;
    }
    operator Parameter() const { return parameter_; }

private:
    Parameter parameter_;
};

}  // namespace cutterflow
