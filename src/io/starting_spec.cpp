#include "tethercalc/io/design_reader.hpp"

namespace tethercalc {

// Holds the fields that everybody has to set and the requirements; the reference of all others is
// docs/spec.md.
std::string starting_spec() {
  return R"({
  "name": "My tethered drone",
  "notes": "A quadrotor of 1.7 kg on 30 m of tether, to be edited. Units are part of the names.",
  "drone": {
    "mass_g": 1710,
    "motor_count": 4,
    "motor": "holybro-air2216-920kv-10in",
    "auxiliary_power_W": 15,
    "drag": {
      "front_area_m2": 0.0145,
      "top_area_m2": 0.0136,
      "linear_m_s": 19.3
    }
  },
  "tether": {
    "length_m": 30,
    "conductor": "aluminium",
    "insulation": {
      "material": "pvc",
      "thickness_mm": 0.75
    }
  },
  "supply": {
    "voltage_V": 75,
    "converter": {
      "efficiency": 0.9,
      "min_input_voltage_V": 20
    }
  },
  "flight": {
    "airspeed_m_s": 8,
    "air_density_kg_m3": 1.225
  },
  "requirements": {
    "thrust_headroom": 2.0,
    "headroom_at": "hover",
    "power_at": "forward",
    "max_pitch_deg": 45
  }
}
)";
}

}  // namespace tethercalc
