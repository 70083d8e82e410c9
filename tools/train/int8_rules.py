# SPDX-License-Identifier: Apache-2.0
"""core/nn in numpy, bit for bit: what the trainer quantises to, and what the kernels' golden vectors come from.

Activations are int8 in -127..127, weights [outputs][inputs] likewise, sums int32. The rules are those of the headers in
core/nn; docs/model_format.md has them in one place.
"""
import numpy as np

NARROW_SUM = 258
WHOLE_SHARE = 127


def quantize_weights(weights):
    """float [N][K] -> (int8 [N][K], scale [N]) with weights ~ scale * int8, the largest magnitude of an output at 127.

    An output whose neighbouring weights would not fit a narrow sum (core/nn/linear.hpp) gets a slightly larger scale.
    """
    w = np.asarray(weights, np.float64)
    largest = np.maximum(np.abs(w).max(axis=1), 1e-30)
    scale = largest / 127
    while True:
        q = np.clip(np.rint(w / scale[:, None]), -127, 127).astype(np.int8)
        wide = ~is_narrow(q)
        if not wide.any():
            return q, scale
        scale[wide] *= 1.01


def is_narrow(w):
    """[N] bool: every four magnitudes that a kernel adds in 16 bits fit (inputs k, k + 1, k + 4, k + 5 of each 8)."""
    n, k = w.shape
    padded = np.zeros((n, -(-k // 8) * 8), np.int64)
    padded[:, :k] = np.abs(w.astype(np.int64))
    pairs = padded.reshape(n, -1, 2, 2, 2).sum(axis=(2, 4))  # [N][eighths][half]; the axes: group, half, within
    alone = k % 8 != 0 and k % 8 <= 4  # the last group has no partner: always fits
    if alone:
        pairs = pairs[:, :-1]
    return (pairs <= NARROW_SUM).all(axis=(1, 2))


def fixed_point(scale):
    """Positive factors below 0.5 -> (multiplier, shift), int32 arrays: factor ~ multiplier / 2^shift."""
    scale = np.asarray(scale, np.float64)
    mantissa, exponent = np.frexp(scale)  # scale = mantissa * 2^exponent, mantissa in 0.5..1
    multiplier = np.rint(mantissa * 2**31).astype(np.int64)
    shift = 31 - exponent.astype(np.int64)
    over = multiplier == 2**31
    multiplier[over] //= 2
    shift[over] -= 1
    if (shift < 32).any() or (shift > 62).any():
        raise ValueError(f"a factor is outside 2^-32 .. 0.5: {scale.min()} .. {scale.max()}")
    return multiplier.astype(np.int32), shift.astype(np.int32)


def pad_outputs(values, fill=0):
    """[N] -> [N rounded up to 8]. fill: 0 for a bias, 2**30 for a multiplier, 32 for a shift."""
    values = np.asarray(values)
    return np.concatenate([values, np.full(-len(values) % 8, fill, values.dtype)])


def linear_sums(rows, weights, bias):
    """[M][K] int8, [N][K] int8, [N] int32 -> [M][N] int64 that fit 32 bits."""
    sums = rows.astype(np.int64) @ weights.astype(np.int64).T + bias.astype(np.int64)
    assert np.abs(sums).max(initial=0) < 2**31
    return sums


def scale_sums(sums, multiplier, shift):
    """floor(sum * multiplier / 2^shift + 1/2), per output."""
    shift = shift.astype(np.int64)
    return (sums * multiplier.astype(np.int64) + (np.int64(1) << (shift - 1))) >> shift


def requantize(sums, multiplier, shift, lowest):
    return np.clip(scale_sums(sums, multiplier, shift), lowest, 127).astype(np.int8)


def gather(image, kernel, stride_y=1, stride_x=1):
    """[H][W][C] -> [H'][W'][kernel * kernel * C]: what a convolution sees, round in x, zeros beyond the ends of y."""
    h, w, _ = image.shape
    half = kernel // 2
    padded = np.pad(image, ((half, half), (0, 0), (0, 0)))
    taps = [np.roll(padded[ky:ky + h], half - kx, axis=1) for ky in range(kernel) for kx in range(kernel)]
    return np.concatenate(taps, axis=2)[::stride_y, ::stride_x]


def conv2d(image, weights, bias, multiplier, shift, lowest, kernel, stride_y=1, stride_x=1):
    seen = gather(image, kernel, stride_y, stride_x)
    flat = seen.reshape(-1, seen.shape[2])
    return requantize(linear_sums(flat, weights, bias), multiplier, shift, lowest).reshape(*seen.shape[:2], -1)


def exp2_down(d):
    """2^15 * 2^(-d / 256) in integers."""
    d = np.minimum(d, 4096)
    f = d & 255
    inner = 22642 - ((f * (7520 - ((f * 1262) >> 8))) >> 8)
    return (32768 - ((f * inner) >> 8)) >> (d >> 8)


def soft_assign(sums, multiplier, shift):
    """[M][K] -> [M][K] shares, each row about 127 in all. multiplier and shift bring sums to 1/256 of an octave."""
    logits = scale_sums(sums, multiplier, shift)
    e = exp2_down(logits.max(axis=1, keepdims=True) - logits)
    factor = (WHOLE_SHARE << 24) // e.sum(axis=1, keepdims=True)
    return (e * factor + (1 << 23)) >> 24


def _sum_in_order(values):
    return np.cumsum(values, dtype=np.float32)[-1]


def round_to_int8(values):
    """float32 -> floor(value + 1/2), clamped."""
    return np.clip(np.floor(values + np.float32(0.5)), -127, 127).astype(np.int8)


def net_vlad(rows, weights, bias, multiplier, shift, centres, output_scale):
    """[M][C] int8 -> [K][C] int8. centres: float32 [K][C]."""
    shares = soft_assign(linear_sums(rows, weights, bias), multiplier, shift)
    sums = (shares.T @ rows.astype(np.int64)).astype(np.float32)
    v = sums - shares.sum(axis=0).astype(np.float32)[:, None] * centres.astype(np.float32)
    squares = np.array([_sum_in_order(row * row) for row in v], np.float32)
    occupied = squares > 0
    factor = np.zeros_like(squares)
    factor[occupied] = np.float32(1) / np.sqrt(squares[occupied])
    to_output = np.float32(1) / (np.sqrt(np.float32(occupied.sum())) * np.float32(output_scale))
    return round_to_int8(v * (factor * to_output)[:, None])


def exp(x):
    """float32 array -> float32, the polynomial of core/nn/exponential.hpp."""
    f = np.float32
    x = np.clip(x, f(-87), f(88))
    shifter = f(12582912)
    n = (x * f(1.44269504) + shifter) - shifter
    r = x - n * f(0.693359375)
    r = r - n * f(-2.12194440e-4)
    p = np.full_like(x, f(1) / f(5040))
    for c in (f(1) / f(720), f(1) / f(120), f(1) / f(24), f(1) / f(6), f(0.5), f(1), f(1)):
        p = p * r + c
    return p * ((n.astype(np.int32) + 127) * (1 << 23)).view(np.float32)


def self_attention(v, gamma):
    """Eq. 1 on float32 [C], C a multiple of 8, in the kernel's order of additions."""
    out = v.copy()
    for x in v:
        top = x * (v.max() if x > 0 else v.min())
        row = exp(x * v - top)
        lanes = np.cumsum(row.reshape(-1, 8), axis=0, dtype=np.float32)[-1]
        factor = np.float32(gamma) * x / _sum_in_order(lanes)
        out = out + factor * row
    return out


def sigmoid_table():
    """[256]: 128 sigmoid(q / 16) for q = -128..127."""
    q = np.arange(-128, 128)
    return np.floor(128 / (1 + np.exp(-q / 16)) + 0.5).astype(np.int64)


def gate(v, logits):
    """v * sigmoid(logits / 16), both int8."""
    return ((v.astype(np.int64) * sigmoid_table()[logits.astype(np.int64) + 128] + 64) >> 7).astype(np.int8)
