"""Kernels of nonlinear parts after a step is found: works, commit, error, defect."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._jit import inlined_by_llvm, kernel
from frames.assembly.system import (
    HERTZ,
    HINGES,
    MAXWELL,
    N_PLASTIC,
    STOP,
    VISCOUS,
    WORK_DONE,
)
from frames.kernels.effective import rates_after
from frames.kernels.hinges import place, set_forces

if TYPE_CHECKING:
    from frames.bundles.nonlinear_data import NonlinearElements
    from lir_element.layout import Floats


@inlined_by_llvm
def plastic_work(parts: NonlinearElements, k: int) -> float:
    """Add the energy that part `k` dissipated in the step (and stored by hardening)."""
    at = parts.first[k]
    total = 0.0
    if parts.kind[k] == HINGES:
        before, after = parts.small[9, :5], parts.small[10, :5]
        set_forces(parts.par[k], parts.old[k], parts.d_old[at : at + 5], before)
        set_forces(parts.par[k], parts.new[k], parts.d[at : at + 5], after)
        for p in range(N_PLASTIC):
            hinge = p // 3
            c = place(hinge, p % 3)
            done = 0.5 * (before[c] + after[c]) * (parts.new[k, p] - parts.old[k, p])
            parts.new[k, WORK_DONE + hinge] += done
            total += done
        return total
    elastic = parts.elastic[at]
    mean = 0.5 * (elastic * (parts.d_old[at] + parts.d[at]) + 2.0 * parts.g_old[at])
    mean += 0.5 * parts.change[at]
    done = -mean * parts.change[at] / elastic
    parts.new[k, WORK_DONE] += done
    return float(done)


@inlined_by_llvm
def add_part_work(parts: NonlinearElements) -> None:
    """Add the step's works of all parts: of yielding, of dampers, of stops and ties."""
    for k in range(parts.kind.shape[0]):
        at = parts.first[k]
        if parts.kind[k] == HINGES or parts.elastic[at] > 0.0:
            if parts.loose[k] == 1:
                parts.work[0] += plastic_work(parts, k)
            continue
        done = (parts.g_old[at] + 0.5 * parts.change[at]) * (parts.d[at] - parts.d_old[at])
        parts.new[k, WORK_DONE] += done
        damper = parts.kind[k] == VISCOUS or parts.kind[k] == MAXWELL
        parts.work[1 if damper else 2] += done


@inlined_by_llvm
def commit_parts(parts: NonlinearElements, beta: float, gamma: float, dt: float) -> None:
    """Accept the trial state of all parts, and their forces in frame coordinates."""
    add_part_work(parts)
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        change = parts.change[i]
        if change != 0.0:
            for a in range(parts.load_b.shape[0]):
                parts.load_b[a] += change * parts.to_b[i, a]
            for k in range(parts.load_e.shape[0]):
                parts.load_e[k] += change * parts.to_e[i, k]
    for i in range(parts.d.shape[0]):
        way = parts.d[i] - parts.d_old[i]
        parts.v_old[i], parts.a_old[i] = rates_after(
            way, parts.v_old[i], parts.a_old[i], dt, beta, gamma
        )
        parts.d_old[i] = parts.d[i]
        parts.g_before[i] = parts.g_old[i]
        parts.g_old[i] += parts.change[i]
    for k in range(parts.kind.shape[0]):
        for i in range(parts.first[k], parts.first[k + 1]):
            parts.flow_old[i] = parts.flow[i] if parts.loose[k] == 1 else 0.0
        for n in range(parts.old.shape[1]):
            parts.old[k, n] = parts.new[k, n]


@inlined_by_llvm
def part_energy_on(load: Floats, parts: NonlinearElements, to: Floats, step: Floats) -> float:
    """Return the work of the parts' forces g over a step of coordinates, by the trapezoid."""
    total = 0.0
    for a in range(step.shape[0]):
        total += load[a] * step[a]
    for n in range(parts.counts[0].active):
        i = parts.active[n]
        value = 0.5 * parts.change[i]
        if value != 0.0:
            for a in range(step.shape[0]):
                total += value * to[i, a] * step[a]
    return total


@inlined_by_llvm
def part_error(parts: NonlinearElements, ratio: float) -> float:
    """Return the squared second difference of the parts' forces, for the error of a step."""
    total = 0.0
    for i in range(parts.d.shape[0]):
        bend = parts.change[i] - ratio * (parts.g_old[i] - parts.g_before[i])
        bend *= parts.scale[i]
        total += bend * bend
    return total


@inlined_by_llvm
def part_defect(parts: NonlinearElements) -> float:
    """Return the energy that stops make or lose by opening and closing within the step."""
    total = 0.0
    for k in range(parts.kind.shape[0]):
        if (parts.kind[k] == STOP or parts.kind[k] == HERTZ) and parts.loose[k] == 1:
            i = parts.first[k]
            x_old, x = parts.d_old[i] - parts.par[k, 0], parts.d[i] - parts.par[k, 0]
            if (x_old > 0.0) != (x > 0.0):
                power = parts.par[k, 2] if parts.kind[k] == HERTZ else 1.0
                total += wall_defect(parts.par[k, 1], power, x_old, x)
    return total


@kernel
def wall_defect(stiffness: float, power: float, x_old: float, x: float) -> float:
    """Return the error of the trapezoid's work of an elastic wall between x_old and x."""
    store, mean = 0.0, 0.0
    for sign, depth in ((-1.0, x_old), (1.0, x)):
        if depth > 0.0:
            force = stiffness * depth**power
            store += sign * force * depth / (power + 1.0)
            mean += 0.5 * force
    return abs(mean * (x - x_old) - store)
