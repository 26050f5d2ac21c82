#pragma once
/// \file Pieces of HTML. Text goes in through escape(); markup comes from the report alone.
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace cutterflow::postproc::html {

/// Text with the characters that HTML reads as markup replaced.
std::string escape(const std::string& text);

/// A table; cells are markup (escape text first). The first column of every row is its heading; `numeric` aligns the others right.
std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows, bool numeric);

/// A table (markup) that may be wider than the window: it scrolls by itself.
std::string scrolling(const std::string& table);

/// Static content that page.js replaces on screen by what it makes of `data`; without scripts, and in print, the content stays.
/// \param kind  how page.js draws it: "plot" (plotly's data and layout) or "head" (head_view.hpp)
std::string replaceable(const std::string& content, const std::string& kind, const nlohmann::json& data);

/// Data that the page's script finds by their id.
std::string data(const std::string& id, const nlohmann::json& data);

std::string figure(const std::string& content, const std::string& caption, const std::string& css_class = "");

/// A list of colours and their meanings (markup).
std::string legend(const std::vector<std::pair<std::string, std::string>>& entries);

std::string section(const std::string& title, const std::string& content);

/// A block for each text that a reader has to know before the numbers. \param texts  not markup, without a final dot
std::string notices(const std::vector<std::string>& texts);

/// A box with one number: its label, the value in large letters, a detail; all markup. \param colour  of its upper edge
std::string answer(const char* colour, const std::string& label, const std::string& value, const std::string& detail);

/// A whole page with the project's style, scripts, time of writing and footer. All three are markup. The page forbids itself any request
/// but for pictures beside it.
std::string document(const std::string& title, const std::string& body, const std::string& footer);

}  // namespace cutterflow::postproc::html
