"""A saddle of Bézier patches, balls around points and fog become one picture.

python3 scene_to_picture.py FOLDER writes scene.png and saddle.vdb there.
"""

import pathlib
import sys

import numpy as np

import bandvox


def saddle() -> bandvox.Grid:
    """The solid between z = (x² - y²) / 2 and a floor, of one patch, without triangles."""
    x, y = np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], indexing="ij")
    square = np.array([0.5, -0.5, 0.5])
    net = np.stack([x, y, square[:, None] - square[None, :]], axis=-1)
    return bandvox.bandlimit(bandvox.Patches([net]), base=-1.2, resolution=64)


def main(folder: pathlib.Path) -> None:
    ground = saddle()
    ground.write(folder / "saddle.vdb")
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    ring = np.column_stack([0.8 * np.cos(angles), 0.8 * np.sin(angles), 0.7 + 0 * angles])
    balls = bandvox.bandlimit_points(ring, radius=np.linspace(0.08, 0.2, 12), resolution=96)
    cloud = bandvox.bandlimit("shape:sphere", resolution=24)

    scene = [
        bandvox.SceneObject(ground, color=(0.5, 0.6, 0.4)),
        bandvox.SceneObject(balls, color=(0.9, 0.4, 0.1), reflectance=0.06, roughness=0.2),
        bandvox.SceneObject(cloud, mode="volume", extinction=6, scale=0.35, translate=(0, 0, 0.8)),
    ]
    picture = bandvox.render(
        scene, width=320, height=240, samples=4, up=(0, 0, 1), from_=(1, -2, 1), fov=35, shadows=True,
        lights=[bandvox.Light((0.3, -0.5, 1), size=4)],
        environment=bandvox.Environment(color=(0.3, 0.4, 0.5)))
    picture.write(folder / "scene.png")
    print(f"{(picture.image[..., 3] > 0).mean():.0%} of the picture is covered")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
