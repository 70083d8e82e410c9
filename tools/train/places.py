# SPDX-License-Identifier: Apache-2.0
"""Sets of places with several views each: which are the same, drawn into batches, and how well they are found again."""
import numpy as np
from scipy.spatial import cKDTree

SAME_M, OTHER_M = 8.0, 16.0  # nearer is the same place, farther is another one, between counts for neither
HIT_M = 10.0
TILE_M = 150.0


class Places:
    """A file of inputs.py. part: None for all, "train" or "test" for the black or white tiles of a 150 m board."""

    def __init__(self, path, part=None):
        self.data = np.load(path)
        self.name = f"{path}:{part}" if part else str(path)
        self.image, self.drive, self.position, self.heading = (
            self.data[k] for k in ("image", "drive", "position", "heading"))
        tile = np.floor(self.position[:, :2] / TILE_M).astype(int).sum(1) % 2
        self.chosen = np.ones(len(tile), bool) if part is None else tile == (part == "test")
        self.index = np.flatnonzero(self.chosen)
        self.tree = cKDTree(self.position[self.index])
        self.same = dict(zip(self.index, (self.index[n] for n in self.tree.query_ball_point(self.position[self.index], 7))))

    def images(self, index, variant):
        """float32 [..., 3, 32, 64] in units of the first band's root mean square."""
        return self.image[index, variant].astype(np.float32) / 64

    def _partner(self, i, rng):
        """Another view of place i: of another drive or from the other direction where there is one."""
        pool = self.same[i]
        other = pool[self.drive[pool] != self.drive[i]]
        turned = pool[np.abs((self.heading[pool] - self.heading[i] + np.pi) % (2 * np.pi) - np.pi) > 1]
        if len(other) and rng.random() < 0.7:
            pool = other
        if len(turned) and rng.random() < 0.4:
            pool = turned
        return rng.choice(pool)

    def neighbourhood(self, rng, places):
        """Up to `places` pairs of views within 150 m, the places at least 12 m apart: as hard to tell apart as a map's."""
        near = self.index[self.tree.query_ball_point(self.position[rng.choice(self.index)], 150)]
        rng.shuffle(near)
        chosen = []
        for i in near[:60]:
            if not chosen or np.linalg.norm(self.position[chosen] - self.position[i], axis=1).min() > 12:
                chosen.append(i)
            if len(chosen) == places:
                break
        views = self.image.shape[1]
        for i in chosen:
            j = self._partner(i, rng)
            v, w = (0 if rng.random() < 0.25 else rng.integers(views) for _ in range(2))
            if i == j and v == w:
                w = (w + 1) % views
            yield (i, v), (j, w)


def open_places(text):
    """FILE.npz, FILE.npz:train or FILE.npz:test."""
    path, _, part = text.partition(":")
    return Places(path, part or None)


def draw_batch(sets, rng, neighbourhoods, places):
    """([(set, place, view)], same [n, n], other [n, n]): which pairs of the views are of one place, which of two."""
    weight = np.sqrt([len(s.index) for s in sets])
    views = []
    for _ in range(neighbourhoods):
        which = rng.choice(len(sets), p=weight / weight.sum())
        views += [(sets[which], *view) for pair in sets[which].neighbourhood(rng, places) for view in pair]
    position = np.array([s.position[i] for s, i, _ in views])
    origin = np.array([id(s) for s, _, _ in views])
    apart = np.linalg.norm(position[:, None] - position[None], axis=2)
    apart[origin[:, None] != origin[None]] = np.inf
    return views, (apart < SAME_M) & ~np.eye(len(apart), dtype=bool), apart > OTHER_M


def recall(places, query, database, gap_m=60):
    """(Recall@1, queries): a query has another view within 10 m, of another drive or at least gap_m of path earlier; a hit
    is a most similar one among those that is within 10 m. query, database: descriptors [n, d] of unit length."""
    if len(np.unique(places.drive)) > 1:
        allowed = places.drive[:, None] != places.drive[None]
    else:
        path = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(places.position, axis=0), axis=1))])
        allowed = path[:, None] - path[None] >= gap_m
    allowed &= places.chosen[:, None]
    true = allowed & (np.linalg.norm(places.position[:, None] - places.position[None], axis=2) <= HIT_M)
    asked = np.flatnonzero(true.any(1))
    found = np.where(allowed[asked], query[asked] @ database.T, -2).argmax(1)
    return true[asked, found].mean() if len(asked) else float("nan"), len(asked)
