#include "solver/observe/head/production_watch.hpp"

#include <array>
#include <cmath>
#include <istream>
#include <ostream>

namespace cutterflow::coupling {
namespace {

constexpr std::array<std::vector<double> ProductionSeries::*, 5> k_columns{
    &ProductionSeries::time, &ProductionSeries::fed, &ProductionSeries::delivered, &ProductionSeries::spilled, &ProductionSeries::held};

}  // namespace

void ProductionWatch::add(double time, const RockLedger& ledger) {
    series_.time.push_back(time);
    series_.fed.push_back(ledger.fed);
    series_.delivered.push_back(ledger.delivered);
    series_.spilled.push_back(ledger.spilled());
    series_.held.push_back(ledger.held());
    if (ends_a_turn(series_.time.size() - 1)) is_known_ = tells_enough(series_);
}

/// Whether a whole revolution of the series ends at its value `i` or since the one before.
bool ProductionWatch::ends_a_turn(std::size_t i) const {
    const auto turn_at = [&](double moment) { return std::floor((moment - series_.time.front()) / revolution_ * (1.0 + 1e-12)); };
    return i > 0 && turn_at(series_.time[i]) > turn_at(series_.time[i - 1]);
}

bool ProductionWatch::tells_enough(const ProductionSeries& series) const {
    const std::optional<Production> production = production_of(series, revolution_);
    return production && production->is_steady && production->share && production->share->half_interval <= target_;
}

/// As it was told at the end of the last whole revolution.
bool ProductionWatch::was_known() const {
    std::size_t asked = series_.time.size();
    while (asked > 0 && !ends_a_turn(asked - 1)) --asked;
    ProductionSeries until = series_;
    for (const auto column : k_columns) (until.*column).resize(asked);
    return asked > 0 && tells_enough(until);
}

void ProductionWatch::write(std::ostream& stream) const {
    const auto count = static_cast<std::uint64_t>(series_.time.size());
    stream.write(reinterpret_cast<const char*>(&count), sizeof count);
    for (const auto column : k_columns)
        stream.write(reinterpret_cast<const char*>((series_.*column).data()), static_cast<std::streamsize>(count * sizeof(double)));
}

bool ProductionWatch::restore(std::istream& stream) {
    const std::istream::pos_type begin = stream.tellg();
    stream.seekg(0, std::ios::end);
    const auto bytes = static_cast<std::uint64_t>(stream.tellg() - begin);
    stream.seekg(begin);
    std::uint64_t count = 0;
    stream.read(reinterpret_cast<char*>(&count), sizeof count);
    constexpr std::uint64_t row = k_columns.size() * sizeof(double);
    if (!stream || (bytes - sizeof count) % row != 0 || (bytes - sizeof count) / row != count) return false;
    ProductionSeries series;
    for (const auto column : k_columns) {
        (series.*column).resize(count);
        stream.read(reinterpret_cast<char*>((series.*column).data()), static_cast<std::streamsize>(count * sizeof(double)));
    }
    if (!stream) return false;
    series_ = std::move(series);
    is_known_ = was_known();
    return true;
}

}  // namespace cutterflow::coupling
