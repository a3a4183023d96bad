"""Types of the compiled module. The package's own functions, which check arguments, are documented beside it."""

from typing import Any

import numpy
from numpy.typing import NDArray

version: str
statuses: tuple[str, ...]

class Mesh:
    """A triangle mesh in its own frame and length unit; it never changes."""

    @property
    def name(self) -> str:
        """A file's or a model's name."""
    @property
    def hash(self) -> str:
        """Content hash of both arrays: 32 hexadecimal digits."""
    @property
    def vertices(self) -> NDArray[numpy.float64]:
        """Shape (n, 3), read only, not copied."""
    @property
    def triangles(self) -> NDArray[numpy.uint32]:
        """Shape (m, 3), indices into `vertices`, counter-clockwise seen from outside; read only, not copied."""
    @property
    def faces(self) -> NDArray[numpy.uint32]:
        """The same as `triangles`."""
    @property
    def box(self) -> NDArray[numpy.float64]:
        """Lower and upper corner of the axis-aligned bounding box, shape (2, 3)."""
    @property
    def center(self) -> NDArray[numpy.float64]:
        """Of the box, shape (3,)."""
    @property
    def centroid(self) -> NDArray[numpy.float64]:
        """Centre of mass of the enclosed body, shape (3,)."""
    @property
    def diagonal(self) -> float:
        """Length of the box's diagonal."""
    @property
    def area(self) -> float:
        """Of the surface (length^2)."""
    @property
    def volume(self) -> float:
        """Signed (length^3); that of a body only where `solid` is true."""
    @property
    def closed(self) -> bool:
        """Whether there is no border."""
    @property
    def solid(self) -> bool:
        """Whether it is closed, consistently oriented and faces outwards: responses need that."""
    @property
    def why_not_solid(self) -> str:
        """Empty if it is."""
    def save(self, file: str) -> None:
        """Writes PLY, OBJ, OFF or STL, whole or not at all. Raises BadFile."""

class PreparedPair:
    settings: str
    prepared: int
    def footprint(self) -> dict[str, float]: ...
    def collide(self, poses: NDArray[numpy.float64], threads: int) -> dict[str, Any]: ...
    def distance(self, poses: NDArray[numpy.float64], threads: int) -> dict[str, Any]: ...
    def respond(self, poses: NDArray[numpy.float64], threads: int) -> dict[str, Any]: ...

class ConfigurationSet:
    hash: str
    a_name: str
    b_name: str
    same_mesh: bool
    def buckets(self) -> list[dict[str, Any]]: ...
    def mesh(self, is_b: bool, instead: str) -> Mesh: ...
    def sample(self, bucket: str, a: Mesh, b: Mesh, count: int, seed: int) -> dict[str, Any]: ...
    def translations(self, bucket: str) -> NDArray[numpy.float64]: ...
    def rotations(self, bucket: str) -> NDArray[numpy.float64]: ...
    def directions(self, bucket: str) -> NDArray[numpy.float64]: ...

class Scene:
    name: str
    recipe: str
    margin: float
    hash: str
    frames: int
    def meshes(self) -> list[Mesh]: ...
    def bodies(self) -> dict[str, Any]: ...
    def frame(self, index: int) -> tuple[NDArray[numpy.uint32], NDArray[numpy.float64]]: ...
    def play(self, algorithm: str, question: str) -> tuple[list[dict[str, Any]], dict[str, Any]]: ...
    def save(self, file: str) -> None: ...

def set_data_folder(folder: str) -> None: ...
def data_folder() -> str: ...
def load(name_or_file: str) -> Mesh: ...
def build_mesh(vertices: NDArray[numpy.float64], triangles: NDArray[numpy.int64], name: str) -> Mesh: ...
def algorithms() -> list[dict[str, Any]]: ...
def prepare(name: str, a: Mesh, b: Mesh, parameters: dict[str, str]) -> PreparedPair: ...
def catalogue(manifest: str) -> list[dict[str, Any]]: ...
def open_set(file: str) -> ConfigurationSet: ...
def load_scene(file: str) -> Scene: ...
def make_scene(family: str, numbers: dict[str, float]) -> Scene: ...
def build_scene(meshes: list[Mesh], mesh_of: list[int], fixed: list[bool], poses: NDArray[numpy.float64],
                margin: float, name: str) -> Scene: ...
def scene_algorithms() -> list[dict[str, Any]]: ...
def scene_families() -> dict[str, str]: ...
def scenarios() -> list[str]: ...
def record_signals(scenario: str, shape: dict[str, str], algorithm: str, parameters: dict[str, str], steps: int,
                   law: str, file: str) -> dict[str, Any]: ...
def read_signals(file: str) -> dict[str, Any]: ...
def read_results(files: list[str]) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]: ...
