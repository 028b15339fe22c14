#pragma once

#include <optional>
#include <string>

#include "misfit/data/candidates.h"
#include "misfit/discover/leaving.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

// What effects of a study's model are worth beside the others of it, now that these are there.

/// The model as fitted, without an effect of it, refitted; nullopt as without_effect().
[[nodiscard]] std::optional<Without> model_without(Session& session, const std::string& effect);

/// The same if the effect's strengths are small (may_leave()) and what it explains may be chance (may_be_chance()).
[[nodiscard]] std::optional<Without> needless(Session& session, const std::string& effect, double families);

/// Why so many parameters gain too little: their drop may be chance (may_be_chance()), or their gain of the held-out log-likelihood is less
/// than discovery asks for (least_held_out_gain()). Empty: they gain enough, as far as it is known.
[[nodiscard]] std::string why_too_little(const std::optional<double>& drop, const std::optional<double>& held_out_gain, int parameters,
                                         double families);

/// freed_width() of an effect of the model as fitted.
[[nodiscard]] std::optional<FreedWidth> width_of(Session& session, const std::string& effect);

/// The whole search (discover()) in the model without it.
[[nodiscard]] Discovery search_without(Session& session, const Without& without);

/// What another effect explains in the place of the one that has gone, screened and refitted there; nullopt: it could not be.
[[nodiscard]] std::optional<Candidate> in_its_place(Session& session, const Without& without, const Candidate& other);

}  // namespace misfit
