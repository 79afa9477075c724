// C09 is judged from what the study of jiggle measures: alter its figures and the verdict turns round. Truth: the project's own
// claims.toml; the figures are made up, in the form that the study writes them.
#include "analysis/verdict.hpp"

#include "analysis/atomic_file.hpp"
#include "analysis/claims.hpp"
#include "analysis/measurement.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::Measurement;
using analysis::VerdictKind;

VerdictKind verdict(const std::vector<Measurement>& measured)
{
    const auto claims = analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE);
    const auto jiggle = std::find_if(claims.begin(), claims.end(), [](const analysis::Claim& claim) { return claim.id == "C09"; });
    analysis::Records records;
    records.measurements = measured;
    return judge(*jiggle, records).kind;
}

Measurement figure(const std::string& quantity, double value)
{
    return {"C09", quantity, "limb, k_stretch 0.1, 10 ms, 24 iterations, unit masses", value, value, value, "1"};
}

std::vector<Measurement> set_by_k_stretch_alone()
{
    return {figure("damping ratio", 0.1), figure("rank correlation of frequency and k_stretch", 1.0),
            figure("frequency at half the time step over at the whole", 1.0),
            figure("frequency at twice the iterations over at the once", 1.02), figure("frequency", 7.0)};
}

TEST(JiggleVerdict, PassiveAndSetByOneScalarIsReproduced)
{
    EXPECT_EQ(verdict(set_by_k_stretch_alone()), VerdictKind::reproduced);
}

TEST(JiggleVerdict, AnyQuantityOutsideItsBoundTakesTheWholeAway)
{
    const double outside[] = {0.0, 0.5, 2.0, 1.3};
    for (std::size_t i = 0; i < 4; ++i) {
        auto measured = set_by_k_stretch_alone();
        measured[i].value = measured[i].low = measured[i].high = outside[i];
        EXPECT_EQ(verdict(measured), VerdictKind::reproduced_only_for) << measured[i].quantity;
    }
}

TEST(JiggleVerdict, AllOutsideIsNotReproduced)
{
    EXPECT_EQ(verdict({figure("damping ratio", -0.1), figure("rank correlation of frequency and k_stretch", 0.1),
                       figure("frequency at half the time step over at the whole", 2.0),
                       figure("frequency at twice the iterations over at the once", 1.4)}),
              VerdictKind::not_reproduced);
    EXPECT_EQ(verdict({figure("frequency", 7.0)}), VerdictKind::not_computable);
}

}  // namespace
