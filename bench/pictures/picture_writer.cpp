#include "bench/pictures/picture_writer.h"

#include "bench/pictures/ppm.h"
#include "core/base/whole_file.h"

namespace tetrace {

PictureWriter::PictureWriter(const std::string& ending)
{
    if (ending != ".ppm") images_.emplace();
}

void PictureWriter::write(const std::filesystem::path& path, const Pixmap& pixmap) const
{
    write_whole(path, images_ ? images_->bytes(path.extension().string(), pixmap) : ppm_bytes(pixmap));
}

} // namespace tetrace
