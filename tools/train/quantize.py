#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a trained descriptor into the agent's int8 model: quantize.py MODEL.pt --calibrate SET.npz ... -o MODEL.mwm --name NAME

Batch norms are folded into weights, scales are taken from the calibration places, and the integer network is run beside
the floating-point one: the cosine between both is printed. --golden writes test vectors.
"""
import argparse

import numpy as np
import torch
import torch.nn.functional as F

from inputs import plan_image
from int8_rules import fixed_point, pad_outputs, quantize_weights, requantize
from model_blob import pack_weights, write_model
from network import DESCRIPTOR, SHARE, TrainedCode, fuse, image_features
from places import open_places, recall
from submaps import read_submaps


class IntegerConv:
    """What core/nn/conv2d computes, exactly."""

    def __init__(self, layer, in_step, out_step):
        scale = (layer.norm.weight / torch.sqrt(layer.norm.running_var + layer.norm.eps)).detach().double().numpy()
        weights = layer.conv.weight.detach().double().numpy() * scale[:, None, None, None]
        self.shape = weights.shape
        rows = weights.transpose(0, 2, 3, 1).reshape(len(weights), -1)  # K counts ky, kx, c
        self.rows, step = quantize_weights(rows)
        bias = layer.norm.bias.detach().double().numpy() - layer.norm.running_mean.double().numpy() * scale
        self.bias = np.rint(bias / (in_step * step)).astype(np.int32)
        self.multiplier, self.shift = fixed_point(in_step * step / out_step)
        self.stride = layer.conv.stride

    def __call__(self, x):
        n, c, h, w = self.shape[0], self.shape[1], *self.shape[2:]
        kernel = torch.from_numpy(self.rows.reshape(n, h, w, c).transpose(0, 3, 1, 2).astype(np.float64).copy())
        x = F.pad(F.pad(torch.from_numpy(x.astype(np.float64)), (1, 1, 0, 0), mode="circular"), (0, 0, 1, 1))
        sums = F.conv2d(x, kernel, stride=self.stride).numpy().astype(np.int64) + self.bias[None, :, None, None]
        return requantize(sums, *(v[:, None, None] for v in (self.multiplier, self.shift)), 0)

    def tensors(self, name):
        return {f"{name}.weight": pack_weights(self.rows), f"{name}.bias": pad_outputs(self.bias),
                f"{name}.multiplier": pad_outputs(self.multiplier, 2**30), f"{name}.shift": pad_outputs(self.shift, 32)}


class IntegerNetwork:
    def __init__(self, network, x):
        """x: calibration images, float [n, 3, 32, 64]."""
        with torch.no_grad():
            seen = [network.input_norm(x - 1)]
            for layer in (network.first, network.second, network.third):
                seen.append(layer(seen[-1]))
            features = network.feature_norm(network.features(x, image_features(x)))
        # Rare peaks are cut so that all the rest is finer.
        steps = [float(np.quantile(s.abs().numpy(), 0.99999)) / 127 for s in seen]
        feature_step = float(np.quantile(features.abs().numpy(), 0.99999)) / 127

        norm = network.input_norm
        scale = (norm.weight / torch.sqrt(norm.running_var + norm.eps)).detach().double().numpy()
        self.input_scale = (scale / 64 / steps[0]).astype(np.float32)
        self.input_offset = ((norm.bias.detach().double().numpy() - (1 + norm.running_mean.double().numpy()) * scale)
                             / steps[0]).astype(np.float32)
        self.convs = [IntegerConv(layer, steps[i], steps[i + 1])
                      for i, layer in enumerate((network.first, network.second, network.third))]
        self.steps = steps
        self.map_step = np.float32(steps[3])
        self.feature_step = feature_step
        norm = network.feature_norm
        scale = (norm.weight / torch.sqrt(norm.running_var + norm.eps)).detach().double().numpy()
        self.feature_scale = (scale / feature_step).astype(np.float32)
        self.feature_offset = ((norm.bias.detach().double().numpy() - norm.running_mean.double().numpy() * scale)
                               / feature_step).astype(np.float32)
        self.rows, step = quantize_weights(network.last.weight.detach().double().numpy())
        self.output_scale = (step * feature_step).astype(np.float32)
        self.network = network

    def stages(self, pixels):
        """uint8 [n, 3, 32, 64] -> what each stage puts out, in the units of the floating-point network."""
        x = pixels.astype(np.float32) * self.input_scale[None, :, None, None] + self.input_offset[None, :, None, None]
        x = np.floor(np.clip(x, -127, 127) + np.float32(0.5)).astype(np.int64)
        out = {"input": x * self.steps[0]}
        for name, conv, step in zip(("first", "second", "third"), self.convs, self.steps[1:]):
            x = conv(x)
            out[name] = x * step
        image = torch.from_numpy(pixels.astype(np.float32) / 64)
        feature_map = torch.from_numpy(x.astype(np.float32) * self.map_step)
        with torch.no_grad():
            features = torch.cat([self.network.map_features(feature_map), image_features(image)], 1)
        features = features.numpy() * self.feature_scale + self.feature_offset
        q = np.floor(np.clip(features, -127, 127) + np.float32(0.5))
        out["features"] = q * self.feature_step
        code = (q.astype(np.float64) @ self.rows.T.astype(np.float64)).astype(np.float32) * self.output_scale
        out["code"] = code / np.linalg.norm(code, axis=1, keepdims=True)
        return out

    def __call__(self, pixels):
        """uint8 [n, 3, 32, 64] -> float32 [n, 256] of unit length."""
        return self.stages(pixels)["code"]

    def tensors(self):
        out = {"input.scale": self.input_scale, "input.offset": self.input_offset}
        for name, conv in zip(("first", "second", "third"), self.convs):
            out |= conv.tensors(name)
        out |= {"map.scale": np.array([self.map_step]), "feature.scale": self.feature_scale,
                "feature.offset": self.feature_offset, "last.weight": pack_weights(self.rows),
                "last.bias": pad_outputs(np.zeros(len(self.rows), np.int32)), "output.scale": self.output_scale}
        return out


class IntegerCode:
    """The agent's descriptor before its last rounding to int8."""

    def __init__(self, model, images, share):
        model.eval()
        x = torch.from_numpy(images)
        self.model, self.share = model, np.float32(share)
        self.network = IntegerNetwork(model.network, x)
        with torch.no_grad():
            spread = model.spectrum(image_features(x)).std(0).numpy()
        # The features in which places differ most, in the order of the image's features.
        self.index = np.sort(np.argsort(-spread, kind="stable")[:DESCRIPTOR - model.outputs]).astype(np.int32)

    def __call__(self, pixels):
        with torch.no_grad():
            spectrum = self.model.spectrum(image_features(torch.from_numpy(pixels.astype(np.float32) / 64)))
        return fuse(spectrum[:, torch.from_numpy(self.index).long()], torch.from_numpy(self.network(pixels)),
                    float(self.share)).numpy()

    def tensors(self):
        gain = torch.exp(self.model.spectrum.log_gain).detach().numpy()[self.index]
        return {"network.share": np.array([self.share]), "spectrum.index": self.index, "spectrum.gain": gain,
                **self.network.tensors()}


def float_stages(network, pixels):
    """What IntegerNetwork.stages stands for."""
    image = torch.from_numpy(pixels.astype(np.float32) / 64)
    with torch.no_grad():
        out = {"input": network.input_norm(image - 1)}
        for name, before in (("first", "input"), ("second", "first"), ("third", "second")):
            out[name] = getattr(network, name)(out[before])
        of_image = image_features(image)
        out["features"] = network.feature_norm(network.features(image, of_image))
        out["code"] = network(image, of_image)
    return {name: values.numpy() for name, values in out.items()}


def stage_errors(network, integer, pixels):
    """Root mean square error of each stage of the integer network, in parts of the stage's own root mean square."""
    exact, rounded = float_stages(network, pixels), integer.stages(pixels)
    return {name: float(np.sqrt(np.mean((rounded[name] - exact[name]) ** 2) / np.mean(exact[name] ** 2))) for name in exact}


RING_MEANS, LIMIT_SHARE = 3 * 32, 0.99


class Familiarity:
    """What core/place/familiarity computes. images: uint8 [n, 3, 32, 64], all views of training places."""

    def __init__(self, images):
        means = self.ring_means(images)
        self.mean = means.mean(0)
        variance, axes = np.linalg.eigh(np.cov(means.T))
        # What hardly varies in training is given a hundredth of the mean variance, so that it cannot decide alone.
        whitening = (axes / np.sqrt(variance + 0.01 * variance.mean())).T
        self.whitening = whitening / np.quantile(np.linalg.norm((means - self.mean) @ whitening.T, axis=1), LIMIT_SHARE)

    @staticmethod
    def ring_means(images):
        return images.reshape(-1, RING_MEANS, images.shape[-1]).sum(2, dtype=np.int64) / (64 * images.shape[-1])

    def __call__(self, images):
        """Above 1: unlike all training."""
        return np.linalg.norm((self.ring_means(images) - self.mean) @ self.whitening.T, axis=1)

    def tensors(self):
        return {"familiar.mean": self.mean.astype(np.float32), "familiar.whitening": self.whitening.astype(np.float32)}


def in_parts(run, pixels):
    return np.concatenate([run(pixels[i : i + 256]) for i in range(0, len(pixels), 256)])


def write_golden(path, submap_set, code, familiarity):
    """Four thinned submaps and what the agent must make of them: uint32 count, then per submap uint32 points, int16
    [points, 3] in centimetres, float32 [1024] and float32 how unlike training it is."""
    submaps = list(read_submaps(submap_set))
    with open(path, "wb") as file:
        file.write(np.uint32(4).tobytes())
        for submap in submaps[len(submaps) // 8 :: len(submaps) // 4][:4]:
            centimetres = np.rint(submap.points[::6] * 100).astype("<i2")
            image = plan_image(centimetres.astype(np.float32) * np.float32(0.01))
            file.write(np.uint32(len(centimetres)).tobytes() + centimetres.tobytes())
            file.write(code(image[None]).astype("<f4").tobytes())
            file.write(familiarity(image[None]).astype("<f4").tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model")
    parser.add_argument("--calibrate", nargs="+", required=True, help="the sets of inputs.py that it was trained on")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--name", required=True, help="name and date of the model, for logs")
    parser.add_argument("--share", type=float, default=SHARE, help="of the network in the squared length")
    parser.add_argument("--check", nargs="*", default=[], help=".npz sets on which Recall@1 of both is compared")
    parser.add_argument("--golden", nargs=2, metavar=("SET.bin", "FILE"), help="test vectors for the agent's code")
    a = parser.parse_args()
    model = TrainedCode.load(a.model)
    rng = np.random.default_rng(0)
    sets = [open_places(text) for text in a.calibrate]
    images = np.concatenate([s.images(np.sort(rng.choice(s.index, min(256, len(s.index)), replace=False)), 0)
                             for s in sets])
    integer = IntegerCode(model, images, a.share)
    familiarity = Familiarity(np.concatenate([s.image[s.index].reshape(-1, *s.image.shape[2:]) for s in sets]))
    write_model(a.out, a.name, integer.tensors() | familiarity.tensors())

    def floating(pixels):
        with torch.no_grad():
            spectrum, network = model(torch.from_numpy(pixels.astype(np.float32) / 64))
        return fuse(spectrum[:, torch.from_numpy(integer.index).long()], network, a.share).numpy()

    def network_only(pixels):
        with torch.no_grad():
            return model(torch.from_numpy(pixels.astype(np.float32) / 64))[1].numpy()

    for path in a.check:
        places = open_places(path)
        pixels = places.image[:, 0]
        cosine = (in_parts(network_only, pixels) * in_parts(integer.network, pixels)).sum(1)
        f, q = in_parts(floating, pixels), in_parts(integer, pixels)
        print(f"{path}: network, cosine of int8 and float: mean {cosine.mean():.5f}, lowest {cosine.min():.5f}; "
              f"descriptor, Recall@1: float {recall(places, f, f)[0]:.4f}, int8 {recall(places, q, q)[0]:.4f}; "
              f"unlike training: {(familiarity(pixels) > 1).mean():.4f}")
        errors = stage_errors(model.network, integer.network, pixels[:512])
        print("  error of each stage: " + ", ".join(f"{name} {error:.4f}" for name, error in errors.items()))
    if a.golden:
        write_golden(a.golden[1], a.golden[0], integer, familiarity)


if __name__ == "__main__":
    main()
