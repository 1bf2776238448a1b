#include "diagnose/told_selection.hpp"

namespace tethercalc {

Finding finding_of(const Effect& effect, const SelectedGroup& selected) {
  Finding finding;
  finding.effect = effect.id;
  finding.title = effect.title;
  finding.mechanism = effect.mechanism;
  finding.stage = to_string(effect.stage);
  finding.holdout_rmse_before = selected.rmse_before;
  finding.holdout_rmse_after = selected.rmse_after;
  finding.gain_percent = selected.gain_percent;
  finding.gain_se_percent = selected.gain_se_percent;
  return finding;
}

ErrorBudget error_budget(const Selection& selection) {
  const double all = selection.base.holdout_rmse * selection.base.holdout_rmse;
  ErrorBudget budget;
  double left = 100;
  for (const SelectedGroup& s : selection.selected) {
    const double share = 100 * (s.rmse_before * s.rmse_before - s.rmse_after * s.rmse_after) / all;
    budget.findings.push_back(share);
    left -= share;
  }
  budget.unexplained = left * selection.unnamed.share_percent / 100;
  budget.noise = left - budget.unexplained;
  return budget;
}

}  // namespace tethercalc
