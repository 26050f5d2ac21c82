#include "geometry/base/parameters/parameter.hpp"

#include <stdexcept>

namespace cutterflow {

bool ParameterValues::has(const std::string& key) const {
    return values_.count(key) > 0;
}

bool ParameterValues::gives(const std::string& key) const {
    return has(key) || !where(key).empty();
}

const ParameterValue* ParameterValues::find(const std::string& key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? nullptr : &found->second;
}

template <typename T>
const T& ParameterValues::get(const std::string& key) const {
    const ParameterValue* value = find(key);
    if (value == nullptr) throw NoValue(key);
    const T* typed = std::get_if<T>(value);
    if (typed == nullptr) throw std::logic_error("parameter " + key + " is read as another type than it has");
    return *typed;
}

double ParameterValues::number(const std::string& key) const {
    const ParameterValue* value = find(key);
    if (value != nullptr && std::holds_alternative<std::int64_t>(*value)) return static_cast<double>(std::get<std::int64_t>(*value));
    return get<double>(key);
}

std::int64_t ParameterValues::integer(const std::string& key) const {
    return get<std::int64_t>(key);
}
const std::string& ParameterValues::text(const std::string& key) const {
    return get<std::string>(key);
}
bool ParameterValues::boolean(const std::string& key) const {
    return get<bool>(key);
}
const std::vector<double>& ParameterValues::numbers(const std::string& key) const {
    return get<std::vector<double>>(key);
}
const std::vector<std::string>& ParameterValues::texts(const std::string& key) const {
    return get<std::vector<std::string>>(key);
}

const std::vector<ParameterValues>& ParameterValues::tables(const std::string& name) const {
    static const std::vector<ParameterValues> none;
    const auto found = tables_.find(name);
    return found == tables_.end() ? none : found->second;
}

void ParameterValues::set(const std::string& key, ParameterValue value) {
    values_[key] = std::move(value);
}
void ParameterValues::remove(const std::string& key) {
    values_.erase(key);
    where_.erase(key);
}
std::vector<ParameterValues>& ParameterValues::tables_for_writing(const std::string& name) {
    return tables_[name];
}

std::string ParameterValues::where(const std::string& key) const {
    const auto found = where_.find(key);
    return found == where_.end() ? "" : found->second;
}

void ParameterValues::set_where(const std::string& key, std::string where) {
    where_[key] = std::move(where);
}

}  // namespace cutterflow
