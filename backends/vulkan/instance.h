#pragma once

#include "backends/vulkan/api.h"

#include <memory>
#include <mutex>
#include <string>

namespace tetrace::vulkan {

/// Messages of the validation layers from any thread, kept until they are fetched.
class ValidationLog {
public:
    void add(const std::string& message);
    /// All messages since the last call, one per line; empty if there were none.
    [[nodiscard]] std::string take();

private:
    std::mutex mutex_;
    std::string messages_;
};

/// The Vulkan loader and an instance of API 1.1 without any window system.
class Instance {
public:
    /// Validation layers, synchronization included, are on in debug builds and if the environment variable
    /// TETRACE_VULKAN_VALIDATION is 1, if they are installed (package vulkan-validationlayers).
    /// Throws Error{missing} naming the package if the loader is missing, Error{driver} if it fails.
    Instance();

    [[nodiscard]] const vk::raii::Instance& handle() const { return *handle_; }
    [[nodiscard]] bool validates() const { return validates_; }
    /// Warnings and errors of the validation layers; always empty if they are off.
    [[nodiscard]] ValidationLog& validation_log() const { return *log_; }

private:
    void make();

    std::unique_ptr<ValidationLog> log_ = std::make_unique<ValidationLog>(); // outlives the instance
    std::unique_ptr<vk::raii::Context> loader_;
    std::unique_ptr<vk::raii::Instance> handle_;
    std::unique_ptr<vk::raii::DebugUtilsMessengerEXT> messenger_;
    bool validates_ = false;
};

/// The process's one instance, made at the first call, never destroyed: drivers crash if their libraries are closed
/// while the process exits. Throws as the constructor does.
[[nodiscard]] Instance& instance();

} // namespace tetrace::vulkan
