#include "bench/report/png.h"
#include "bench/report/sections.h"

namespace tetrace {

Section picture_section(const ReportInput& input)
{
    Section section{"pictures", "Pictures", {}};
    Html pictures;
    for (const std::filesystem::path& path : input.pictures)
        pictures += picture_figure(path);
    section.is_empty = pictures.empty();
    section.content =
        pictures.empty()
            ? paragraph("No picture was given: --picture accepts the PNG and PPM files that 'tetrace render' writes "
                        "(the surface, and the steps of each ray), and 'tetrace check' if a row differs.")
            : side_by_side(pictures);
    return section;
}

} // namespace tetrace
