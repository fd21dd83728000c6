// NVML as far as tetrace asks it, with one GPU. TETRACE_STUB_NVML is the word of its throttling, in decimal; "broken"
// lets it not start.
#include <cstdlib>
#include <string_view>

namespace {

constexpr int success = 0, not_found = 6;
int gpu = 0; // its address is the handle

std::string_view asked()
{
    const char* text = std::getenv("TETRACE_STUB_NVML");
    return text != nullptr ? text : "";
}

int answer(unsigned* value, unsigned what)
{
    *value = what;
    return success;
}

int handle_if(bool known, int** handle)
{
    if (!known) return not_found;
    *handle = &gpu;
    return success;
}

} // namespace

extern "C" {

int nvmlInit_v2()
{
    return asked() == "broken" ? 9 : success;
}
int nvmlDeviceGetHandleByUUID(const char* uuid, int** handle)
{
    return handle_if(std::string_view(uuid) == "GPU-00112233-4455-6677-8899-aabbccddeeff", handle);
}
int nvmlDeviceGetHandleByPciBusId_v2(const char* address, int** handle)
{
    return handle_if(std::string_view(address) == "0000:41:00.0", handle);
}
int nvmlDeviceGetClockInfo(int*, unsigned clock, unsigned* mhz)
{
    return answer(mhz, clock == 1 ? 1980 : 2619);
}
int nvmlDeviceGetPowerUsage(int*, unsigned* milliwatts)
{
    return answer(milliwatts, 412'500);
}
int nvmlDeviceGetTemperature(int*, unsigned, unsigned* degrees)
{
    return answer(degrees, 51);
}
int nvmlDeviceGetCurrentClocksThrottleReasons(int*, unsigned long long* reasons)
{
    *reasons = std::strtoull(asked().data() != nullptr ? asked().data() : "0", nullptr, 10);
    return success;
}
}
