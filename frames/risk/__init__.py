"""Fragility, risk and campaigns of many time histories."""

from frames.risk._errors import CampaignError as CampaignError
from frames.risk._errors import FragilityError as FragilityError
from frames.risk.campaign.archive import archive_campaign as archive_campaign
from frames.risk.campaign.campaign import Campaign as Campaign
from frames.risk.campaign.devices import Device as Device
from frames.risk.campaign.loss import ExpectedLoss as ExpectedLoss
from frames.risk.campaign.loss import LossComponent as LossComponent
from frames.risk.campaign.loss import expected_loss as expected_loss
from frames.risk.campaign.loss_file import read_components as read_components
from frames.risk.campaign.measures import Measure as Measure
from frames.risk.campaign.other_databases import convert_campaign as convert_campaign
from frames.risk.campaign.sampling import ParameterSample as ParameterSample
from frames.risk.campaign.sampling import full_grid as full_grid
from frames.risk.campaign.sampling import latin_hypercube as latin_hypercube
from frames.risk.campaign.sampling import saltelli_sample as saltelli_sample
from frames.risk.campaign.sampling import sobol_sample as sobol_sample
from frames.risk.campaign.search import MedianSearch as MedianSearch
from frames.risk.campaign.store import CampaignStatus as CampaignStatus
from frames.risk.campaign.store import CampaignStore as CampaignStore
from frames.risk.campaign.store import open_campaign as open_campaign
from frames.risk.fragility.analyses import cloud_analysis as cloud_analysis
from frames.risk.fragility.analyses import ida as ida
from frames.risk.fragility.analyses import multiple_stripes as multiple_stripes
from frames.risk.fragility.cloud_fit import fit_cloud as fit_cloud
from frames.risk.fragility.comparison import Comparison as Comparison
from frames.risk.fragility.comparison import compare_fragility as compare_fragility
from frames.risk.fragility.curve import CollapseFragility as CollapseFragility
from frames.risk.fragility.curve import Fragility as Fragility
from frames.risk.fragility.curve import lognormal_fragility as lognormal_fragility
from frames.risk.fragility.files import load_fragility as load_fragility
from frames.risk.fragility.files import save_fragility as save_fragility
from frames.risk.fragility.fitting import fit_capacities as fit_capacities
from frames.risk.fragility.fitting import fit_stripes as fit_stripes
from frames.risk.fragility.hazard_curve import HazardCurve as HazardCurve
from frames.risk.fragility.hunt_fill import HuntFill as HuntFill
from frames.risk.fragility.incremental import IDA as IDA
from frames.risk.fragility.intensity import Intensity as Intensity
from frames.risk.fragility.intensity import IntensityMeasure as IntensityMeasure
from frames.risk.fragility.limit_state import LimitState as LimitState
from frames.risk.fragility.of_runs import fragility_of as fragility_of
from frames.risk.fragility.paired_tests import paired_tests as paired_tests
from frames.risk.fragility.risk import Risk as Risk
from frames.risk.fragility.risk import RiskWarning as RiskWarning
from frames.risk.fragility.risk import collapse_margin_ratio as collapse_margin_ratio
from frames.risk.fragility.risk import mean_annual_frequency as mean_annual_frequency
from frames.risk.fragility.runs import IntensityRuns as IntensityRuns
from frames.risk.fragility.sensitivity import Tornado as Tornado
from frames.risk.fragility.sensitivity import tornado as tornado
from frames.risk.fragility.sobol import SobolIndices as SobolIndices
from frames.risk.fragility.sobol import sobol_indices as sobol_indices
from lir_element import _lazy

__all__ = _lazy.listed(__file__)
