/* lensprof/lensprof.h - the whole public API.
 *
 * Example: a lens that loses 35 % of the light in the corners, removed from a linear picture, in place.
 *
 *     lensprof_profile_init(&profile);
 *     profile.vignetting[0].k[0] = -0.35;
 *     status = lensprof_correct(&profile, NULL, &picture, &error);
 */
#ifndef LENSPROF_LENSPROF_H
#define LENSPROF_LENSPROF_H

#include "apply.h"
#include "base.h"
#include "deflicker.h"
#include "exposure_settings.h"
#include "exposures.h"
#include "fields.h"
#include "fit.h"
#include "fixed.h"
#include "flat.h"
#include "formats.h"
#include "geometry.h"
#include "hugin.h"
#include "model.h"
#include "online.h"
#include "packed.h"
#include "profile.h"
#include "reason.h"
#include "rendering.h"
#include "sample.h"
#include "sensor.h"
#include "store.h"
#include "trial.h"

#endif
