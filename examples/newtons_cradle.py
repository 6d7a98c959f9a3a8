"""Newton's cradle: what the last of five balls takes, and what the others keep, for balls that touch and for balls that do not."""

import vibroimpact as vi

LAW = vi.find_contact_law("hertz")(stiffness=1e9)  # steel balls, some 20 mm thick

for gap in (0.0, 1e-6, 1e-5, 1e-4):
    balls = {f"ball {number}": vi.MovingBody(mass=0.1, velocity=(1.0 if number == 1 else 0.0, 0.0, 0.0)) for number in range(1, 6)}
    contacts = {
        f"{number} on {number + 1}": vi.PointContact(
            below=f"ball {number}", above=f"ball {number + 1}", law=LAW, gap=gap, normal=(1.0, 0.0, 0.0)
        )
        for number in range(1, 5)
    }
    response = vi.simulate_system(vi.System(bodies=balls, contacts=contacts), duration=2e-3)
    speeds = [f"{float(moved.velocity[0]):8.5f}" for moved in response.at(2e-3).values()]
    print(f"gaps of {1e6 * gap:5.1f} um: speeds {' '.join(speeds)} m/s, closure {response.energy['closure_relative']:.1g}")
