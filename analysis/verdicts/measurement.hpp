// Values that a study measured for a claim: the tables of its runs, and the values that the frames of a scene give.
//   for (const Measurement& measured : measurements("measurements.csv")) ...
#pragma once

#include "analysis/verdicts/case_record.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace analysis {

// The rows of the file `csv`: claim, quantity, the fields of the key, value, low, high and unit. The columns limit, n
// and not_reached exist if a row uses one of them. run is left empty. InputError as for read_csv, for a missing column,
// for a cell that is not a number, and for an unknown limit.
std::vector<Measurement> measurements(const std::string& csv);
// the table that measurements() reads; run is not part of it
CsvTable measurement_table(const std::vector<Measurement>& measurements);

// The values of a quantity whose cases differ in one field of the key alone, by this field: the iterations on each
// mesh. Each series has the key without the field. Values without the field are left out.
//   for (const auto& [of, amplitudes] : series_over(measured, "amplitude", &CaseKey::k_stretch))
//       use(amplitudes.begin()->first);
std::map<CaseKey, std::map<double, Measurement>> series_over(const std::vector<Measurement>& measured,
                                                             const std::string& quantity,
                                                             std::optional<double> CaseKey::*field);

// The value of a quantity in a case; null if there is none.
const Measurement* find_measurement(const std::vector<Measurement>& measured, const std::string& quantity,
                                    const CaseKey& of);

inline constexpr double kept_volume_pct = 0.5;  // the paper's Sec. 4: "the volume is preserved within 0.5 %"
double share_of_kept_frames(const std::vector<double>& volume_change_pct);

// What the frames of a scene and deformer give, with body, motion, deformer, variant, order and precision as key:
//   mean_volume_loss_pct            mean of -volume_change_pct (the paper's E = V0 - V'); its range is that of the
//                                   frames
//   mean_volume_abs_change_pct      likewise of volume_abs_change_pct
//   share_of_frames_within_half_pct |volume_change_pct| <= 0.5
// A sweep gives volume_loss_pct and volume_abs_change_pct of each frame, with its angle, since its frames are no sample
// of a motion. A frame that is not finite makes a mean NaN and lies within no bound. InputError for series of different
// lengths.
std::vector<Measurement> frame_measurements(const CaseRecord& record);

}  // namespace analysis
