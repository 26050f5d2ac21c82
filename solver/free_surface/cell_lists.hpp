#pragma once
/// \file Lists of numbers, one for each cell of a grid.
#include <vector>

namespace cutterflow::free_surface {

class CellLists {
public:
    void clear(std::size_t cells) {
        first_.assign(cells, k_none);
        entries_.clear();
    }
    void add(int cell, int number) {
        entries_.push_back({number, first_[cell]});
        first_[cell] = static_cast<int>(entries_.size()) - 1;
    }
    /// Calls visit(number), the last added first.
    template <typename Visit>
    void for_each(int cell, const Visit& visit) const {
        for (int entry = first_[cell]; entry != k_none; entry = entries_[entry].next) visit(entries_[entry].number);
    }

private:
    static constexpr int k_none = -1;
    struct Entry {
        int number, next;
    };
    std::vector<int> first_;  // entry of each cell
    std::vector<Entry> entries_;
};

}  // namespace cutterflow::free_surface
