/* Files of older layouts, which are read as they are: for each of them a table `profiles` with all the columns of the
 * newest layout, in front of a SELECT. */
#ifndef LENSPROF_STORE_LAYOUTS_H
#define LENSPROF_STORE_LAYOUTS_H

#include "store/file/private.h"

/* clang-format off */

/* Up to layout 3 the method ended in what the profile holds and whether it was forced: "transfer+12 (forced)".
 * profiles/schema/0004_prior.sql moves it to columns by the same rule. */
#define LP_WITHOUT_DIGITS(text) "rtrim(" text ", '0123456789')"
#define LP_FORCED_3 "(substr(method, -9) = ' (forced)')"
#define LP_NAMED_3 "substr(method, 1, length(method) - 9 * " LP_FORCED_3 ")" /* "transfer+12" */
#define LP_PLUS_3 LP_WITHOUT_DIGITS(LP_NAMED_3)                              /* "transfer+" */
#define LP_HAS_PRIOR_3 LP_PLUS_3 " LIKE '%+' AND " LP_PLUS_3 " <> " LP_NAMED_3

#define LP_CIRCLE_6 "NULL AS circle_x, NULL AS circle_y, NULL AS circle_radius" /* what layout 7 adds */
#define LP_LEVELS_5 /* what layout 6 adds, too */ \
    "NULL AS black_red, NULL AS black_green, NULL AS black_blue, NULL AS white_level, " LP_CIRCLE_6
#define LP_STYLE_4 "'' AS style, NULL AS gamma_sigma, " LP_LEVELS_5 /* what layout 5 adds, too */
#define LP_SINCE_1 \
    "id, camera_maker, camera_model, lens, focal_mm, aperture, distance_m, processing, software, source," \
    " created_unix_s, images, pairs, heldout_rms, inlier_share, response_curves, vignetting_curves, covariance_size," \
    " covariance, "
#define LP_UNITS_3 "gain_grids, unit, crop_factor, doubt, lens_name"
#define LP_WITH_PROFILES(columns) "WITH profiles AS NOT MATERIALIZED (SELECT " columns " FROM main.profiles) "
#define LP_PROFILES_3(columns) \
    LP_WITH_PROFILES(LP_SINCE_1 "NULL AS color_temperature_k, " \
    " CASE WHEN " LP_HAS_PRIOR_3 " THEN substr(" LP_PLUS_3 ", 1, length(" LP_PLUS_3 ") - 1)" \
    " ELSE " LP_NAMED_3 " END AS method," \
    " CASE WHEN " LP_HAS_PRIOR_3 " THEN nullif(CAST(substr(" LP_NAMED_3 ", length(" LP_PLUS_3 ") + 1) AS INTEGER), 0)" \
    " END AS prior_id, " LP_FORCED_3 " AS forced, " LP_STYLE_4 ", " columns)
#define LP_PROFILES_6 \
    LP_WITH_PROFILES(LP_SINCE_1 "method, color_temperature_k, prior_id, forced, style, gamma_sigma, black_red," \
                     " black_green, black_blue, white_level, " LP_CIRCLE_6 ", " LP_UNITS_3)
#define LP_PROFILES_5 \
    LP_WITH_PROFILES(LP_SINCE_1 "method, color_temperature_k, prior_id, forced, style, gamma_sigma, " LP_LEVELS_5 \
                     ", " LP_UNITS_3)
#define LP_PROFILES_4 \
    LP_WITH_PROFILES(LP_SINCE_1 "method, color_temperature_k, prior_id, forced, " LP_STYLE_4 ", " LP_UNITS_3)
/* A name without ASCII case, blanks and signs, as 0003_units.sql makes lens_name; the index profiles_by_rendering
 * (0005_cameras.sql) has the same expression. */
#define LP_SQUEEZED(column) \
    "lower(replace(replace(replace(replace(replace(replace(" column \
    ", ' ', ''), '-', ''), '/', ''), '.', ''), '(', ''), ')', ''))"
#define LP_UNITS_2 "'' AS unit, NULL AS crop_factor, '' AS doubt, " LP_SQUEEZED("lens") " AS lens_name"

/* The statement for each layout: `sql` is a literal that begins with SELECT and names no column that is not in the
 * newest `profiles`. */
#define LP_BY_LAYOUT(sql) \
    {LP_PROFILES_3("0 AS gain_grids, " LP_UNITS_2) sql, LP_PROFILES_3("gain_grids, " LP_UNITS_2) sql, \
     LP_PROFILES_3(LP_UNITS_3) sql, LP_PROFILES_4 sql, LP_PROFILES_5 sql, LP_PROFILES_6 sql, sql}

/* clang-format on */
#endif
