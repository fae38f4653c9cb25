# SPDX-License-Identifier: MIT
"""Signed distances with derivatives in torch and in JAX: the gradient to poses is the library's, in closed form.

Poses are quaternions x, y, z, w and translations, (n, 7). A quaternion may be of any length: the derivative along it
is 0. Needs torch or JAX; each is used where it is installed.
"""
import importlib.util

import numpy as np

import pirouette

pair = pirouette.Pair(pirouette.Polytope.shape("box?x=1&y=0.5&z=0.25"), pirouette.Polytope.shape("icosahedron"))


def distance_and_slope(poses):
    """Distances, (n,), and their derivatives by the seven numbers of each pose, (n, 7)."""
    found = pair.signed_distance(poses, gradient=True)
    x, y, z, w = (poses[:, i] for i in range(4))
    torque, length = found.gradient[:, 3:], (poses[:, :4]**2).sum(axis=1)
    # a change dq of the quaternion turns by the vector part of 2 dq q* / |q|^2
    turns = 2 * np.stack([np.stack([w, -z, y, -x], axis=1), np.stack([z, w, -x, -y], axis=1),
                          np.stack([-y, x, w, -z], axis=1)], axis=1) / length[:, None, None]
    return found.distance, np.hstack([(torque[:, :, None] * turns).sum(axis=1), found.gradient[:, :3]])


def torch_distance():
    """A function of torch tensors that back-propagates."""
    import torch

    class Distance(torch.autograd.Function):
        @staticmethod
        def forward(context, poses):
            distance, slope = distance_and_slope(poses.detach().cpu().double().numpy())
            context.save_for_backward(torch.as_tensor(slope, dtype=poses.dtype, device=poses.device))
            return torch.as_tensor(distance, dtype=poses.dtype, device=poses.device)

        @staticmethod
        def backward(context, by_distance):
            slope, = context.saved_tensors
            return by_distance[:, None] * slope

    return Distance.apply


def jax_distance():
    """A function of JAX arrays that can be compiled and differentiated."""
    import jax

    def asked(poses):
        shapes = (jax.ShapeDtypeStruct(poses.shape[:1], poses.dtype), jax.ShapeDtypeStruct(poses.shape, poses.dtype))
        return jax.pure_callback(lambda p: tuple(a.astype(p.dtype) for a in distance_and_slope(np.asarray(p, float))),
                                 shapes, poses)

    @jax.custom_vjp
    def distance(poses):
        return asked(poses)[0]

    distance.defvjp(asked, lambda slope, by_distance: (by_distance[:, None] * slope,))
    return distance


random = np.random.default_rng(1)
poses = np.hstack([random.normal(size=(50, 4)), random.uniform(-1.5, 1.5, (50, 3))])
# by differences, which hold where no other features come nearest
distance, slope = distance_and_slope(poses)
for i in range(7):
    step = np.zeros(7)
    step[i] = 1e-6
    change = (distance_and_slope(poses + step)[0] - distance_and_slope(poses - step)[0]) / 2e-6
    assert np.median(np.abs(change - slope[:, i])) < 1e-7

tried = []
if importlib.util.find_spec("torch"):
    import torch
    tensor = torch.tensor(poses, requires_grad=True)
    torch_distance()(tensor).square().sum().backward()
    assert np.allclose(tensor.grad.numpy(), 2 * distance[:, None] * slope)
    tried.append("torch")
if importlib.util.find_spec("jax"):
    import jax
    jax.config.update("jax_enable_x64", True)
    found = jax.jit(jax.grad(lambda p: (jax_distance()(p)**2).sum()))(poses)
    assert np.allclose(found, 2 * distance[:, None] * slope)
    tried.append("JAX")
print(f"gradients hold by differences, and in {' and '.join(tried) or 'neither torch nor JAX, which are not here'}")
print("done: derivatives")
