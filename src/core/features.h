/* Parts of the core that a small processor may leave out. */
#ifndef LENSPROF_CORE_FEATURES_H
#define LENSPROF_CORE_FEATURES_H

/* -DLENSPROF_NO_CHROMA leaves out the correction of colour alone (chroma of lensprof_apply_options). */
#ifdef LENSPROF_NO_CHROMA
#define LP_HAS_CHROMA 0
#else
#define LP_HAS_CHROMA 1
#endif

/* -DLENSPROF_NO_LEVELS leaves out black and white levels. */
#ifdef LENSPROF_NO_LEVELS
#define LP_HAS_LEVELS 0
#else
#define LP_HAS_LEVELS 1
#endif

/* -DLENSPROF_NO_IMAGE_CIRCLE leaves out image circles; blobs that have one are then of an unknown layout. */
#ifdef LENSPROF_NO_IMAGE_CIRCLE
#define LP_HAS_CIRCLE 0
#else
#define LP_HAS_CIRCLE 1
#endif

/* -DLENSPROF_NO_WIDE_CURVES leaves out, in integers (fixed.h), 16 bit samples through a response, and between 8 and 16
 * bit; plans that need it are then CORRUPT. */
#ifdef LENSPROF_NO_WIDE_CURVES
#define LP_HAS_WIDE_CURVES 0
#else
#define LP_HAS_WIDE_CURVES 1
#endif

/* -DLENSPROF_NO_FIXED_GRID leaves out gain grids in integers (fixed.h); plans that have one are then CORRUPT. */
#ifdef LENSPROF_NO_FIXED_GRID
#define LP_HAS_FIXED_GRID 0
#else
#define LP_HAS_FIXED_GRID 1
#endif

#endif
