#include "bench/pictures/picture_writer.h"

#include "bench/pictures/ppm.h"

namespace tetrace {

PictureWriter::PictureWriter(const std::string& ending)
{
    if (ending != ".ppm") images_.emplace();
}

void PictureWriter::write(const std::filesystem::path& path, const Pixmap& pixmap) const
{
    if (images_)
        images_->write(path, pixmap);
    else
        write_ppm(path, pixmap);
}

} // namespace tetrace
