"""Find the damping of Adams' IMPACT from rebound heights that were measured, and how well they tell it."""

import vibroimpact as vi

case = {
    "name": "measured rebounds",
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": {"material": "steel-paper"},
    "drop": {"height": "4 m", "gravity": 9.8},
    "contact": {"law": "adams-impact"},
    "calibrate": {
        "target": {"rebound_heights": ["2.411 m", "1.457 m", "885 mm", "541 mm"], "standard_deviation": "2 mm"},
        "degree": 1,
    },
}
to_calibrate = vi.read_calibration(case)
found = vi.calibrate_case(to_calibrate)

for speed, value, (low, high) in zip(found.observations.speeds, found.values, found.intervals, strict=True):
    print(f"{speed:.3f} m/s: {value:.1f} N s/m, {low:.1f} to {high:.1f} at 95 %")
print("over the speed:", [round(value, 3) for value in found.fit.function.coefficients])
for doubt in found.doubts:
    print("doubt:", doubt)

# the calibrated case runs as any other
response = vi.simulate(vi.calibrated_case(to_calibrate.case, found))
print("rebounds [m]", response.impacts["rebound_height_m"].round(4))
