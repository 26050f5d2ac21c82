#pragma once
/// \file A page under way: where it goes, in which form, and what all its parts share.
#include <filesystem>
#include <string>

#include "postproc/draw/head/head_view.hpp"
#include "postproc/draw/image.hpp"
#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

enum class PageForm {
    live,   ///< one file; plots and head answer the mouse where scripts run
    still,  ///< without scripts, its pictures as PNG files beside it: small enough to publish
};

/// Nothing of the user's is overwritten: a folder of pages is new, empty, or holds the document of an earlier one.
/// \throws UserError  when it holds anything else
void require_own_folder(const std::filesystem::path& folder, const std::filesystem::path& document);

class Page {
public:
    Page(std::filesystem::path file, PageForm form) : file_(std::move(file)), form_(form) {}

    /// A figure as markup: its picture, in a live page what the script draws over it, and its caption.
    /// \throws ToolError  when gnuplot cannot be started or refuses the plot
    std::string draw(const Figure& figure) const;

    /// A picture of the head that a live page lets turn.
    std::string turnable(const std::string& picture, const nlohmann::json& view) const;

    /// Address of a picture: its data in a live page, `<name>.png` beside a still one.
    std::string address(const Image& image, const std::string& name) const;

    /// Surfaces of the heads that the page shows.
    ViewSurfaces& surfaces() { return surfaces_; }

    /// What a still page says of the live one; nothing in a live page. \param command  that makes the live page
    std::string how_to_make_live(const std::string& command) const;

    /// Writes the page and removes what the plots needed.
    void write(const std::string& title, const std::string& body, const std::string& footer) const;

private:
    std::filesystem::path scratch() const { return file_.parent_path() / "plots.part"; }

    std::filesystem::path file_;
    PageForm form_;
    ViewSurfaces surfaces_;
};

}  // namespace cutterflow::postproc
