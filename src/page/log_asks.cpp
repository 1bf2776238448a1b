#include "page/asks.hpp"
namespace tethercalc::page {
std::span<const Ask> log_asks() { return {}; }
}  // namespace tethercalc::page
