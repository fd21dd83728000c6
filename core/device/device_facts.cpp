#include "core/device/device_facts.h"

#include "core/base/printable.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <dlfcn.h>
#include <filesystem>
#include <tuple>

namespace tetrace {

namespace {

bool is_digit(char c)
{
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::string dashed(std::string_view words)
{
    std::string name;
    for (const char c : words) {
        const auto letter = static_cast<unsigned char>(c);
        if (std::isalnum(letter) != 0)
            name += static_cast<char>(std::tolower(letter));
        else if (!name.empty() && name.back() != '-')
            name += '-';
    }
    if (name.ends_with('-')) name.pop_back();
    return name;
}

/// The text's first version number, cut to at most `max_numbers` numbers.
std::string version_in(std::string_view text, int max_numbers)
{
    const auto* const begin = std::ranges::find_if(text, is_digit);
    const auto* end = begin;
    for (int numbers = 0; end != text.end(); ++end) {
        if (is_digit(*end)) continue;
        if (*end != '.' || ++numbers == max_numbers) break;
    }
    std::string version(begin, end);
    while (version.ends_with('.'))
        version.pop_back();
    return version;
}

} // namespace

Device unusable_device(const std::string& name, const std::string& reason)
{
    Device device;
    device.name = device.id = name;
    device.kind = DeviceKind::gpu;
    device.usable = false;
    device.reason = reason;
    return device;
}

Device printable(Device device)
{
    for (std::string* const line : {&device.name, &device.driver, &device.implementation, &device.id, &device.library})
        *line = printable_line(*line);
    device.reason = printable_text(device.reason);
    return device;
}

std::string library_holding(const void* function)
{
    Dl_info library{};
    if (function == nullptr || ::dladdr(function, &library) == 0 || library.dli_fname == nullptr) return {};
    std::error_code failed;
    const auto path = std::filesystem::canonical(library.dli_fname, failed);
    return failed ? library.dli_fname : path.string();
}

std::string hexadecimal(std::span<const std::uint8_t> bytes)
{
    std::string text;
    for (const std::uint8_t byte : bytes) {
        text += "0123456789abcdef"[byte >> 4];
        text += "0123456789abcdef"[byte & 15];
    }
    return text;
}

std::string pci_address(unsigned domain, unsigned bus, unsigned device, unsigned function)
{
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%04x:%02x:%02x.%x", domain, bus, device, function);
    return text.data();
}

std::string id_of(const Device& device)
{
    return !device.uuid.empty() ? device.uuid : !device.pci.empty() ? device.pci : device.name;
}

bool is_same_device(const Device& a, const Device& b)
{
    const auto all = [](const Device& device) { return std::tie(device.name, device.driver, device.uuid, device.pci); };
    return all(a) == all(b);
}

std::string implementation_name(std::string_view driver, std::string_view version)
{
    std::string name = dashed(driver);
    if (name.empty()) name = "unknown";
    const std::string numbers = version_in(version, name.starts_with("nvidia") ? 1 : 2);
    if (!numbers.empty()) name.append("-").append(numbers);
    return name;
}

} // namespace tetrace
