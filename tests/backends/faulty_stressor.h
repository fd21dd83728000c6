// The headers of faulty_stressor.cpp, precompiled.
#pragma once

#include "core/device/backend.h"
#include "core/device/defects.h"
#include "kernels/layouts/defect_words.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <unordered_map>
