"""The order of the gallery: by the numbers in the names of the files, plot_2 before plot_10."""

from pathlib import Path


class ByNumber:
    """A key of sorting for sphinx-gallery."""

    def __init__(self, folder: str) -> None:
        self.folder = folder

    def __call__(self, name: str) -> int:
        return int(Path(name).stem.split("_")[1])
