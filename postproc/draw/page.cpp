#include "postproc/draw/page.hpp"

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/plotly.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;

/// What page.js replaces on screen; in a still page the content alone.
std::string replaceable(PageForm form, const std::string& content, const char* kind, const nlohmann::json& data) {
    return form == PageForm::live ? html::replaceable(content, kind, data) : "<div class=\"static\">" + content + "</div>";
}

}  // namespace

void require_own_folder(const fs::path& folder, const fs::path& document) {
    if (fs::exists(folder) && !fs::is_empty(folder) && !fs::exists(folder / document))
        throw UserError(fmt::format("{} holds files but no {}", folder.string(), document.string()), "Nothing is overwritten",
                        "Name another folder");
}

std::string Page::draw(const Figure& figure) const {
    const std::string plot = replaceable(form_, draw_svg(figure.plot, scratch()), "plot", plotly_figure(figure.plot));
    return html::figure(plot, figure.caption, figure.css_class);
}

std::string Page::turnable(const std::string& picture, const nlohmann::json& view) const {
    return replaceable(form_, picture, "head", view);
}

std::string Page::address(const Image& image, const std::string& name) const {
    if (form_ == PageForm::live) return "data:image/png;base64," + base64(png_bytes(image));
    write_file(file_.parent_path() / (name + ".png"), png_bytes(image));
    return name + ".png";
}

std::string Page::how_to_make_live(const std::string& command) const {
    if (form_ == PageForm::live) return "";
    return fmt::format(
        "<p class=\"operating\" style=\"margin-bottom: 14px\">Still pictures, without scripts. A page whose plots answer the mouse and "
        "whose head turns: "
        "<code>{}</code></p>\n",
        html::escape(command));
}

void Page::write(const std::string& title, const std::string& body, const std::string& footer) const {
    const std::string surfaces = form_ == PageForm::live ? surfaces_.markup() : "";
    write_file(file_, html::document(title, body + surfaces, footer));
    fs::remove_all(scratch());
}

}  // namespace cutterflow::postproc
