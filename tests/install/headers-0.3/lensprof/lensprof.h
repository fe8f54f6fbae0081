/* lensprof/lensprof.h - the whole public API. */
#ifndef LENSPROF_LENSPROF_H
#define LENSPROF_LENSPROF_H

#include "apply.h"
#include "base.h"
#include "fit.h"
#include "fixed.h"
#include "flat.h"
#include "formats.h"
#include "geometry.h"
#include "hugin.h"
#include "model.h"
#include "profile.h"
#include "reason.h"
#include "sample.h"
#include "store.h"

#endif
