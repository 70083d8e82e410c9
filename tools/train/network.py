# SPDX-License-Identifier: Apache-2.0
"""The trained descriptor of core/place (trained_code) in floating point: the image's weighted spectrum and a small
convolutional network. Both programs must compute the same features in the same order."""
import math

import torch
import torch.nn.functional as F
from torch import nn

DESCRIPTOR, NETWORK_OUTPUTS, CHANNELS = 1024, 256, (16, 32, 16)
MAP_RINGS, MAP_ORDERS = 16, 12
IMAGE_RINGS, IMAGE_ORDERS = 32, 18
RELATION_ORDERS, RING_LAG = 8, 4
IMAGE_POWER = IMAGE_RINGS * IMAGE_ORDERS
IMAGE_FEATURES = IMAGE_POWER + 2 * (IMAGE_RINGS - RING_LAG) * RELATION_ORDERS


class Conv(nn.Module):
    """3 x 3, round along directions, zeros beyond the first and last ring; batch norm; ReLU."""

    def __init__(self, inputs, outputs, ring_stride=1):
        super().__init__()
        self.conv = nn.Conv2d(inputs, outputs, 3, (ring_stride, 1), bias=False)
        self.norm = nn.BatchNorm2d(outputs)

    def forward(self, x):
        x = F.pad(F.pad(x, (1, 1, 0, 0), mode="circular"), (0, 0, 1, 1))
        return F.relu(self.norm(self.conv(x)))


def orders(x, n):
    """Angular orders 0..n-1 of [..., directions], scaled by 1 / sqrt(directions): real and imaginary parts."""
    size = x.shape[-1]
    angle = torch.arange(size)[:, None] * torch.arange(n)[None] * (2 * math.pi / size)
    scale = 1 / math.sqrt(size)
    return x @ torch.cos(angle).to(x) * scale, -(x @ torch.sin(angle).to(x)) * scale


def pressed_power(re, im):
    return (re * re + im * im + 1e-6) ** 0.375


def pressed_relation(a, b):
    """[re, im] of a conj(b) with the amplitude pressed to its fourth root; a and b are (re, im) pairs."""
    re, im = a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]
    pressed = pressed_power(re, im)
    return [(re / pressed).flatten(1), (im / pressed).flatten(1)]


def image_features(image):
    """[n, IMAGE_FEATURES] of the first band: power of rings and orders, then relations of rings 4 apart."""
    re, im = orders(image[:, 0], IMAGE_ORDERS)
    k = slice(1, RELATION_ORDERS + 1)
    near, far = slice(0, IMAGE_RINGS - RING_LAG), slice(RING_LAG, IMAGE_RINGS)
    return torch.cat([pressed_power(re, im).flatten(1)]
                     + pressed_relation((re[:, near, k], im[:, near, k]), (re[:, far, k], im[:, far, k])), 1)


class SpectrumCode(nn.Module):
    """One weight for each feature of the image; it starts as the hand-made descriptor."""

    def __init__(self):
        super().__init__()
        start = torch.zeros(IMAGE_FEATURES)
        start[IMAGE_POWER:] = math.log(0.3)
        self.log_gain = nn.Parameter(start)

    def forward(self, features):
        power = features[:, :IMAGE_POWER].reshape(-1, IMAGE_RINGS, IMAGE_ORDERS).clone()
        power[:, :, 0] *= 0.5
        power = (power - 0.5 * power.mean(1, keepdim=True)).flatten(1)
        scaled = torch.cat([F.normalize(power, dim=1), F.normalize(features[:, IMAGE_POWER:], dim=1)], 1)
        return F.normalize(scaled * torch.exp(self.log_gain), dim=1)


class PlanNetwork(nn.Module):
    """channels: of the three maps."""

    def __init__(self, channels=CHANNELS, outputs=NETWORK_OUTPUTS, dropout=0.4, band_dropout=0.25):
        super().__init__()
        self.band_dropout = band_dropout
        self.input_norm = nn.BatchNorm2d(3)
        self.first, self.second, self.third = (
            Conv(3, channels[0], ring_stride=2), Conv(channels[0], channels[1]), Conv(channels[1], channels[2]))
        features = channels[2] * MAP_RINGS * (MAP_ORDERS + RELATION_ORDERS) + IMAGE_FEATURES
        self.feature_norm = nn.BatchNorm1d(features)
        self.dropout = nn.Dropout(dropout)
        self.last = nn.Linear(features, outputs, bias=False)

    def map_features(self, feature_map):
        re, im = orders(feature_map, MAP_ORDERS)
        k = slice(1, RELATION_ORDERS + 1)
        return torch.cat([pressed_power(re, im).flatten(1)]
                         + pressed_relation((re[:, 0::2, :, k], im[:, 0::2, :, k]), (re[:, 1::2, :, k], im[:, 1::2, :, k])), 1)

    def without_bands(self, image):
        """Some sensors see no heights: their upper bands are empty, or the middle one is as full as the first."""
        image = image.clone()
        draw = torch.rand(len(image), device=image.device)
        image[draw < self.band_dropout, 1:] = 0
        same = draw < self.band_dropout / 2
        image[same, 1] = image[same, 0]
        return image

    def features(self, image, of_image):
        seen = self.without_bands(image) if self.training else image
        return torch.cat([self.map_features(self.third(self.second(self.first(self.input_norm(seen - 1))))), of_image], 1)

    def forward(self, image, of_image):
        features = self.feature_norm(self.features(image, of_image))
        return F.normalize(self.last(self.dropout(features)), dim=1)


class TrainedCode(nn.Module):
    """image float [n, 3, 32, 64] in units of the first band's root mean square -> spectrum [n, 1024] with all its features
    and the network's code [n, outputs], both of unit length."""

    def __init__(self, channels=CHANNELS, outputs=NETWORK_OUTPUTS):
        super().__init__()
        self.channels, self.outputs = tuple(channels), outputs
        self.spectrum, self.network = SpectrumCode(), PlanNetwork(channels, outputs)

    def forward(self, image):
        of_image = image_features(image)
        return self.spectrum(of_image), self.network(image, of_image)

    def save(self, path):
        torch.save({"channels": self.channels, "outputs": self.outputs, "state": self.state_dict()}, path)

    @staticmethod
    def load(path):
        saved = torch.load(path, map_location="cpu")
        model = TrainedCode(saved["channels"], saved["outputs"])
        model.load_state_dict(saved["state"])
        return model.eval()


SHARE = 0.15  # of the network: from 0.1 to 0.3 all the same to recall, and with more of it the heading shows


def fuse(spectrum, network, share=SHARE):
    """Side by side, `share` of the squared length for the network."""
    return torch.cat([F.normalize(spectrum, dim=1) * math.sqrt(1 - share), network * math.sqrt(share)], 1)
