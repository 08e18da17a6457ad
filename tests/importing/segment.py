"""Images of grains, and what SPAM finds in them. Run by the Python that has SPAM.

segment.py FRAMES OUT: FRAMES is an .npz with `position` (S, N, 3) and `diameter` (N,) in voxels, `shape` of the images (z, y, x) and `number` (S,) of the frames.
"""
import pathlib
import sys

import numpy as np
import scipy.ndimage
import spam.kalisphera
import spam.label

BLUR, NOISE = 0.8, 0.08  # of the images: width [voxels], standard deviation over the contrast of grains and pores
MARGIN = 3  # around a sphere and around the box, whose walls grains overlap [voxels]
EDGE = MARGIN + 4

frames, out = np.load(sys.argv[1]), pathlib.Path(sys.argv[2])
noise = np.random.default_rng(5)


def image_of(position: np.ndarray) -> np.ndarray:
    """Spheres with exact partial volumes (Tengattini & Ando 2015), blurred, with noise."""
    image = np.zeros(frames["shape"] + 2 * EDGE)
    for (x, y, z), diameter in zip(position, frames["diameter"]):
        centre, half = np.array([z, y, x]) + EDGE, int(diameter / 2) + MARGIN
        low = centre.astype(int) - half
        part = image[tuple(slice(at, at + 2 * half + 1) for at in low)]
        sphere = np.zeros(part.shape)
        spam.kalisphera.makeSphere(sphere, centre - low, float(diameter) / 2)
        np.maximum(part, sphere, out=part)
    image = scipy.ndimage.gaussian_filter(image, BLUR)
    return image + NOISE * noise.standard_normal(image.shape)


for number, position in zip(frames["number"], frames["position"]):
    binary = image_of(position) > 0.5
    labels = spam.label.watershed(binary)
    centres, radii = spam.label.centresOfMass(labels)[1:], spam.label.equivalentRadii(labels)[1:]
    contacts = spam.label.labelledContacts(labels)[3]
    found = np.column_stack([np.arange(1, len(radii) + 1), centres - EDGE, 2 * radii])
    np.savetxt(out / f"grains_{number:02d}.csv", found, "%d,%.4f,%.4f,%.4f,%.4f", header="Label,Zpos,Ypos,Xpos,diameter", comments="")
    np.savetxt(out / f"touching_{number:02d}.csv", contacts, "%d,%d", header="label1,label2", comments="")
