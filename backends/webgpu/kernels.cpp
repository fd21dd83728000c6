#include "backends/webgpu/kernels.h"

#include "backends/embedded.h"
#include "core/base/error.h"

namespace tetrace::webgpu {

std::span<const EmbeddedKernel> embedded_kernels();

namespace {

std::string_view text_named(std::string_view name)
{
    const EmbeddedKernel* const found = find_kernel(embedded_kernels(), name);
    return found == nullptr ? std::string_view() : found->text();
}

} // namespace

std::string_view kernel_text(const KernelId& kernel)
{
    if (kernel.math != MathMode::exact) return {};
    std::string name(name_of(kernel.method));
    name.append("_").append(name_of(kernel.layout));
    if (kernel.task != Task::trace) name.append("_").append(name_of(kernel.task));
    return text_named(name);
}

std::string_view probe_text()
{
    return text_named("probe");
}

std::string_view page_text()
{
    return text_named("page");
}

std::string_view page_script()
{
    return text_named("script");
}

} // namespace tetrace::webgpu
