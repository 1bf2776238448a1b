// The golden designs of the reference data as specs, whose motors and materials are numbers of their own.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

function goldenSpec(inputs, motors) {
  const points = Object.entries(motors[inputs.motor]).filter(([throttle]) => throttle !== 'name')
    .map(([throttle, [grams, efficiency]]) => ({ throttle_percent: Number(throttle), thrust_g: grams, efficiency_g_per_W: efficiency }))
    .sort((a, b) => a.throttle_percent - b.throttle_percent);
  const copper = inputs.conductor === 'copper';
  return {
    name: 'golden',
    drone: { mass_g: inputs.drone_mass_g, motor_count: inputs.motor_count, motor: { points }, auxiliary_power_W: inputs.payload_power_W,
      drag: { front_area_m2: inputs.drag_front_area_m2, top_area_m2: inputs.drag_top_area_m2, linear_m_s: inputs.drag_linear_m_s } },
    tether: { length_m: inputs.tether_length_m,
      conductor: { resistivity_20C_ohm_mm2_per_m: copper ? 0.0178 : 0.0278, temperature_coefficient_per_K: 0, density_g_cm3: copper ? 8.9 : 2.7 },
      insulation: { material: { density_g_cm3: inputs.insulation_density_g_cm3 }, thickness_mm: inputs.insulation_thickness_mm } },
    supply: { voltage_V: inputs.supply_voltage_V,
      converter: { efficiency: inputs.converter_efficiency, min_input_voltage_V: inputs.converter_min_input_voltage_V } },
    flight: { airspeed_m_s: inputs.airspeed_m_s, air_density_kg_m3: inputs.air_density_kg_m3, gravity_m_s2: inputs.gravity_m_s2 },
    requirements: { thrust_headroom: inputs.thrust_headroom },
  };
}

/** Their specs as texts; none where the folder of reference data `shared` has none. */
export function goldenSpecs(shared) {
  const file = shared && join(shared, 'data/golden/reference-designs.json');
  if (!file || !existsSync(file)) return [];
  const data = JSON.parse(readFileSync(file, 'utf8').replaceAll(/\bNaN\b/g, 'null'));
  return (data.designs ?? data.cases).map((design) => JSON.stringify(goldenSpec(design.inputs ?? design, data.motors), null, 1));
}
