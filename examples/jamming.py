#!/usr/bin/python3
"""Isotropic compression beyond jamming (scenes/jamming.toml), pressure and contacts of each model: jamming.py RUN [OUT.png]

phi_J, where packings jam, is fitted to p / E = A (phi - phi_J)^1.5 of independent contacts; standard errors by drawing packings
anew (bootstrap). Z counts grains that carry load: each has four contacts or more with others of them.
"""
import warnings

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np

from run_file import arguments, open_run

FITTED = (2e-4, 3e-3)  # p / E
LOOKS = {"independent": ("Independent contacts", "#0072B2"), "mc_dem": ("MC-DEM", "#D55E00"),
         "elastic_sphere": ("Elastic sphere", "#CC79A7"), "hyperelastic_sphere": ("Hyperelastic sphere", "#666666")}
PHI, P, Z, OVERLAP = range(4)


def load_bearing_contacts(pairs, grains):
    """Contacts per grain of those that are left when grains with fewer than four contacts are taken away."""
    while True:
        contacts = np.bincount(pairs.ravel(), minlength=grains)
        loose = (contacts > 0) & (contacts < 4)
        if not loose.any():
            return 2 * len(pairs) / max(1, (contacts > 0).sum()) or np.nan
        pairs = pairs[~loose[pairs].any(axis=1)]


def scans_of(run, replica):
    """The model; phi, p / E, Z and deepest overlap at every scan."""
    keys = dict(run[f"parameters/{replica}"].asstr()[:])
    rows, grains = run["observables"][replica], len(run[f"particles/{replica}/diameter"])
    p = np.trace(rows["stress"], axis1=1, axis2=2) / 3 / float(keys["grains.youngs_modulus"])
    offset, contacts = run[f"contacts/{replica}/offset"][:], run[f"contacts/{replica}/contact"]
    ends = np.stack([contacts["grain"], contacts["partner"]], axis=1)
    z = [load_bearing_contacts(ends[first:last], grains) for first, last in zip(offset, offset[1:])]
    return keys["contact.model"].strip('"'), np.stack([rows["packing_fraction"], p, z, rows["max_overlap"]])


def read(path):
    """By model, an array of packing, quantity, scan; not-a-number where a packing had stopped."""
    found = {}
    with open_run(path) as run:
        for replica in run["observables"]:
            model, scans = scans_of(run, replica)
            found.setdefault(model, []).append(scans)
    most = max(scans.shape[1] for packings in found.values() for scans in packings)
    return {model: np.stack([np.pad(scans, ((0, 0), (0, most - scans.shape[1])), constant_values=np.nan) for scans in packings])
            for model, packings in found.items()}


def fits(packings):
    """phi_J and A with an exponent of 1.5, the exponent where it is free, and b and B of Z - 6 = B (phi - phi_J)^b."""
    phi, p, z, _ = np.nanmean(packings, axis=0)
    used = (p > FITTED[0]) & (p < FITTED[1])
    slope, offset = np.polyfit(phi[used], p[used] ** (2 / 3), 1)
    jammed = -offset / slope

    starts = phi[used][0] - np.geomspace(1e-4, 0.05, 300)
    free = min((np.polyfit(np.log(phi[used] - start), np.log(p[used]), 1, full=True)[:2] for start in starts),
               key=lambda fitted: fitted[1][0])[0][0]
    b, log_b = np.polyfit(np.log(phi[used] - jammed), np.log(z[used] - 6), 1)
    return np.array([jammed, slope ** 1.5, free, b, np.exp(log_b)])


def with_errors(packings, times=200):
    random = np.random.default_rng(1)
    drawn = [fits(packings[random.integers(len(packings), size=len(packings))]) for _ in range(times)]
    return fits(packings), np.std(drawn, axis=0)


def standard_error(values):
    return np.nanstd(values, axis=0, ddof=1) / np.sqrt(np.isfinite(values).sum(axis=0))


def print_fits(packings):
    print("\nIndependent contacts")
    for words, value, error in zip(("phi_J", "A", "exponent of p, where free", "exponent of Z - 6", "B"), *with_errors(packings)):
        print(f"  {words:26} {value:.4f} +- {error:.4f}")


def print_scans(found):
    independent = found.get("independent")
    for model, packings in found.items():
        last = [scans[PHI, np.isfinite(scans[PHI])][-1] for scans in packings]
        print(f"\n{LOOKS[model][0]}: {len(packings)} packings, the last scans at phi = {min(last):.3f} to {max(last):.3f}")
        print("    phi     p / E      +-  over independent         Z      +-  deepest overlap")
        for scan in np.flatnonzero(np.isfinite(packings[:, PHI]).all(axis=0)):
            phi, p, z, overlap = packings[:, :, scan].T
            if not phi.mean() > 0.64 or scan % 2 == 0:
                continue
            ratio = p / independent[:, P, scan] if independent is not None else np.full(len(p), np.nan)
            print(f"  {phi.mean():.3f}  {p.mean():.5f} {standard_error(p):.5f}     {ratio.mean():.3f} +- {standard_error(ratio):.3f}  "
                  f"{z.mean():8.2f} {standard_error(z):7.2f}  {overlap.max():15.3f}")


def draw(found, picture):
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.2), layout="constrained")
    jammed = fits(found["independent"])[0] if "independent" in found else np.nan
    for model, packings in found.items():
        words, colour = LOOKS[model]
        phi, p, z, _ = np.nanmean(packings, axis=0)
        _, p_error, z_error, _ = standard_error(packings)
        look = {"color": colour, "label": words, "marker": "o", "markersize": 2, "linewidth": 1, "elinewidth": 0.7}
        axes[0].errorbar(phi, p, p_error, **look)
        axes[1].errorbar(phi, z, z_error, **look)
        far, distance = phi > jammed + 0.015, phi - jammed
        axes[2].errorbar(distance[far], p[far] / distance[far] ** 1.5, p_error[far] / distance[far] ** 1.5, **look)
    axes[0].set(yscale="log", xlabel="packing fraction φ", ylabel="pressure p / E", ylim=(1e-5, None))
    axes[1].set(xlabel="packing fraction φ", ylabel="contacts per load-bearing grain Z", ylim=(5.8, None), xlim=(0.635, None))
    axes[2].set(xlabel="φ − φ$_J$", ylabel="p / (E (φ − φ$_J$)$^{1.5}$)", yscale="log", xlim=(0, None))
    axes[2].yaxis.set_minor_formatter("{x:.2g}")
    axes[2].yaxis.set_major_formatter("{x:.2g}")
    axes[0].legend(frameon=False, fontsize=7)
    for one in axes:
        one.grid(color="#dddddd", linewidth=0.4)
        one.set_axisbelow(True)
        one.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=200)
    print(f"\nwrote {picture}")


if __name__ == "__main__":
    path, picture = arguments(__doc__, "jamming.png")
    warnings.simplefilter("ignore", RuntimeWarning)  # means of scans that no packing reached
    found = read(path)
    if "independent" in found:
        print_fits(found["independent"])
    print_scans(found)
    draw(found, picture)
