#!/usr/bin/env python3
"""Reference values for reciprocal fields, made without the program:  python reciprocal.py
Needs Python 3 and mpmath. Writes reciprocal.csv. Helpers and sets of asperities are those of make.py.

The complementary energy C(F, a) of a few spots is written down, and the equilibrium is where
    Phi(F, a) = sum F_i D_i - C(F, a) - g pi sum a_i^2
is stationary, in all loads and radii together. Its derivatives are differences of Phi itself: none
of the equations that the program solves is used.
    C   = sum C_i + sum over pairs M_ij + sum over i of M_ii/2,
    C_i = F d - U(d, a) with F = 2E (a d - a^3/(3R)),
    M   = (F_i s_j(r) + F_j s_i(r))/2,   s = H - (F_H - F) p: a Hertz contact less a flat punch, images
included (M_ii by images alone). At the equilibrium Phi is the potential.
"""

from functools import cache

from make import (APPROACHES, SETS, Jkr, agree, asin, dbl, ewald, g1, images, matrix, mp, mpf,
                  pi, self_term, sqrt, write)

L, E, g = dbl(1e-3), dbl(1e6), dbl(0.07)
HERTZ = (mpf(1) / 10, mpf(9) / 280, mpf(5) / 336)
PUNCH = (mpf(1) / 6, mpf(3) / 40, mpf(5) / 112)

# A pair whose discs reach two thirds of the way to one another's centres.
CLOSE = {"close": [(6.0e-4, 3.0e-4, 0.0, 3.0e-5), (6.11e-4, 3.04e-4, -1.0e-7, 2.6e-5)]}


@cache
def tails(x, y):
    """Sums over all images but the nearest of 1/r^3, 1/r^5, 1/r^7, at a distance in sides."""
    return [images(x, y, m + mpf(1) / 2) / L ** (2 * m + 1) for m in (1, 2, 3)]


def displaced(F, a, R, r, rest, far):
    """Field of a spot at the distance r, by its nearest image (not for r = 0) and by all others."""
    T = 4 * E * a**3 / (3 * R) - F
    w = F * rest
    for m, S in enumerate(far):
        w += (4 * a ** (2 * m + 5) / (3 * R) * HERTZ[m] - T * a ** (2 * m + 2) * PUNCH[m] / E) / pi * S
    if r:
        w += a * a / (pi * R) * g1(r / a) - T * asin(a / r) / (pi * E * a)
    return w


def equilibria(name, spots):
    xs = [tuple(dbl(v) for v in s) for s in spots]
    n = len(xs)
    cs = [Jkr(E, g, s[3]) for s in xs]
    between = {}
    for i in range(n):
        for j in range(i + 1):
            d = [xs[i][k] - xs[j][k] for k in (0, 1)]
            x, y = [v / L - mp.nint(v / L) for v in d]
            rest = ewald(x, y, sqrt(pi))[1] if i != j else self_term()
            between[i, j] = (L * sqrt(x * x + y * y), rest / (pi * E * L), tails(x, y))

    def complementary(F, a):
        C = mpf(0)
        for i in range(n):
            R = xs[i][3]
            d = F[i] / (2 * E * a[i]) + a[i] ** 2 / (3 * R)
            C += F[i] * d - E * (a[i] * d * d - 2 * a[i] ** 3 * d / (3 * R) + a[i] ** 5 / (5 * R * R))
            for j in range(i + 1):
                M = (F[i] * displaced(F[j], a[j], xs[j][3], *between[i, j])
                     + F[j] * displaced(F[i], a[i], R, *between[i, j])) / 2
                C += M if i != j else M / 2
        return C

    def phi(v, D):
        F, a = v[:n], v[n:]
        return sum(f * d for f, d in zip(F, D)) - complementary(F, a) - g * pi * sum(t * t for t in a)

    def gradient(v, D, units):
        all_ = []
        for k in range(2 * n):
            h = units[k] * mpf(10) ** -15
            up, down = list(v), list(v)
            up[k] += h
            down[k] -= h
            all_.append((phi(up, D) - phi(down, D)) / (2 * h))
        return all_

    def solve(delta, guess=None):
        D = [delta + s[2] for s in xs]
        radii = [c.a(max(d, c.d(c.a_off()) / 2)) for c, d in zip(cs, D)]
        units = [E * t * t for t in radii] + radii
        v = list(guess or [c.F(t) for c, t in zip(cs, radii)] + radii)
        for _ in range(12):
            rest = gradient(v, D, units)
            step = mp.lu_solve(hessian(v, D, units), matrix(rest))
            v = [t - s for t, s in zip(v, step)]
            if max(abs(s / u) for s, u in zip(step, units)) < mpf(10) ** -21:
                return v, D, units
        raise SystemExit("no equilibrium: " + name)

    def hessian(v, D, units):
        J = matrix(2 * n, 2 * n)
        for k in range(2 * n):
            h = units[k] * mpf(10) ** -8
            up, down = list(v), list(v)
            up[k] += h
            down[k] -= h
            for i, (p, q) in enumerate(zip(gradient(up, D, units), gradient(down, D, units))):
                J[i, k] = (p - q) / (2 * h)
        return J

    rows = []
    for delta in APPROACHES:
        delta = dbl(delta)
        v, D, units = solve(delta)
        F, a = v[:n], v[n:]
        # Stable: at fixed D the potential, the loads being in equilibrium, has a minimum in the radii.
        J = hessian(v, D, units)
        FF, Fa, aF, aa = J[:n, :n], J[:n, n:], J[n:, :n], J[n:, n:]
        S = aa - aF * FF**-1 * Fa
        scaled = matrix(n, n)
        for i in range(n):
            for j in range(n):
                scaled[i, j] = (S[i, j] + S[j, i]) / 2 * units[n + i] * units[n + j]
        assert min(mp.eigsy(scaled, eigvals_only=True)) > 0, (name, delta)
        h = mpf(10) ** -14
        ends = [phi(*solve(delta + e, v)[:2]) for e in (h, -h)]
        agree("dPhi/d(delta)", (ends[0] - ends[1]) / (2 * h), sum(F), 1e-14)
        potential = phi(v, D)
        for i in range(n):
            d = F[i] / (2 * E * a[i]) + a[i] ** 2 / (3 * xs[i][3])
            rows.append((name, delta, i) + xs[i] + (a[i], D[i] - d, F[i], potential))
    return rows


if __name__ == "__main__":
    chosen = {**{name: SETS[name] for name in ("one", "two", "wrap", "three")}, **CLOSE}
    write("reciprocal.csv",
          ["Coupled equilibria of a few JKR asperities with reciprocal fields, all in contact, periodic square L = 1e-3 m,",
           "E* = 1e6 Pa, dgamma = 0.07 J/m^2: stationary points of Phi(F, a), see reciprocal.py; w_hat = delta + z - d(F, a).",
           "Newton on differences of Phi, 20 digits; stable; dPhi/d(delta) = sum F (14 digits). Pi is Phi there, of all spots together."],
          ["set", "delta", "index", "x", "y", "z", "R", "a", "w_hat", "F", "Pi"],
          [row for name, spots in chosen.items() for row in equilibria(name, spots)])
