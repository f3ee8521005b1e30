"""Tools that others wrote, at most ten lines each: what stands between the marks is in the documentation."""

import numpy as np
import pytest

import gudgeon


@pytest.fixture(scope="module")
def pin() -> gudgeon.Case:
    return gudgeon.example("pin-85-alcohol")


def test_scipy_qmc(pin):
    from scipy.stats import qmc

    f = pin.function({"pin.inner": "mm", "pin.outer": "mm"}, ["pin_mass"])
    x = qmc.scale(qmc.Sobol(d=2, seed=1).random(64), [12, 21], [14, 22])
    mass = f(x)[:, 0]

    # Mass of a tube in g: density, length, ring, with the circle ratio that this case has from its source.
    exact = 7850e3 * 61.9e-3 * 3.14159267 / 4 * (x[:, 1] ** 2 - x[:, 0] ** 2) * 1e-6
    np.testing.assert_allclose(mass, exact, rtol=1e-12)


def test_salib(pin):
    from SALib import ProblemSpec

    f = pin.function({"pin.inner": "mm", "pin.outer": "mm"}, "pin_mass")
    problem = ProblemSpec({"names": list(f.inputs), "bounds": [[12, 14], [21, 22]], "outputs": f.outputs})
    problem.sample_sobol(256, seed=1).evaluate(lambda x: f(x)).analyze_sobol(seed=1)
    main = problem.analysis["S1"]

    # The mass is a sum of squares of the inputs: shares of the variances of d^2 over [12, 14] and [21, 22], and no interaction.
    variance = [(b**5 - a**5) / (5 * (b - a)) - ((b**3 - a**3) / (3 * (b - a))) ** 2 for a, b in ([12, 14], [21, 22])]
    # 256 base points: an error of the indices of about 1/256.
    np.testing.assert_allclose(main, np.array(variance) / sum(variance), atol=0.01)


def test_optuna(pin):
    import optuna

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    f = pin.function({"pin.inner": "mm", "pin.outer": "mm"}, "pin_mass", failed=1e3)

    def mass(trial):
        return f([trial.suggest_float("inner", 12, 14), trial.suggest_float("outer", 21, 22)])

    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=1))
    study.optimize(mass, n_trials=40)

    # The lightest pin is that of the largest hole in the smallest outside; the search comes near that corner.
    assert study.best_params["inner"] > 13.5 and study.best_params["outer"] < 21.25


def test_pymoo(pin):
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.core.problem import Problem
    from pymoo.optimize import minimize

    f = pin.function({"pin.inner": "mm", "pin.outer": "mm"}, ["pin_mass", "deflection"], failed=1e3)

    class Pin(Problem):
        def _evaluate(self, x, out, *args, **kwargs):
            out["F"] = f(x)

    front = minimize(Pin(n_var=2, n_obj=2, xl=[12, 21], xu=[14, 22]), NSGA2(pop_size=20), ("n_gen", 10), seed=1).F

    # A lighter pin bends more: along the front one falls where the other rises.
    order = front[np.argsort(front[:, 0])]
    assert len(front) > 5 and (np.diff(order[:, 1]) < 0).all()
