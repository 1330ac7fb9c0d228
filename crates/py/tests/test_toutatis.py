"""Nature: the seventeen radar attitudes of Toutatis of 1992, fitted by a free rotation. Periods and rms are those of an independent fit by integration."""

import csv
from datetime import datetime

import numpy as np
import pytest
from conftest import REPOSITORY

from andoyer import Body, Scene

pytest.importorskip("scipy")
from scipy.spatial.transform import Rotation

from andoyer import fit


@pytest.fixture(scope="module")
def radar():
    lines = (REPOSITORY / "tests/data/toutatis_attitudes.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    dates = [datetime.fromisoformat(row["utc"]) for row in rows]
    days = [(date - dates[0]).total_seconds() / 86400 for date in dates]
    attitudes = Rotation.from_euler("ZXZ", [[float(row[name]) for name in ("alpha", "beta", "gamma")] for row in rows], degrees=True)
    return days, attitudes, np.radians([float(rows[0][name]) for name in ("w1", "w2", "w3")])


@pytest.mark.parametrize("moments", [[3.0836, 3.235, 1.0], [2.0, 2.2, 1.0]])
def test_free_rotation_fits_the_radar_attitudes_of_toutatis_to_seven_degrees(radar, moments):
    days, attitudes, rates = radar
    assert len(days) == 17
    found = fit.attitudes(Scene(Body(moments), attitudes[0], rates), days, attitudes, sigma=np.radians(5))
    rms = np.degrees(np.sqrt(np.mean(np.sum(found.residuals**2, axis=1))))
    motion = found.scene.solve()
    assert 7.0 < rms < 8.0 and motion.plan.mode == "long-axis"
    assert 5.37 < motion.periods["long-axis"].rotation < 5.38 and 7.39 < motion.periods["long-axis"].precession < 7.45
    assert found.message.startswith("The data do not determine a common factor of the moments, nor the difference of the moments I1 and I2 (")
    ratios = found.scene.body.moments[:2] / found.scene.body.moments[2]
    assert np.allclose(ratios, [3.0836, 3.235], atol=0.3)
    states = found.ensemble(500, rng=1)
    spread = states.periods["long-axis"]
    # The uncertainties: some hundredths of a day.
    assert 0.002 < spread.rotation.std() < 0.05 and 0.01 < spread.precession.std() < 0.1
    assert 0.1 < (states.moments[:, 0] / states.moments[:, 2]).std() < 0.4
