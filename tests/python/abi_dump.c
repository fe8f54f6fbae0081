/* Prints what the C compiler makes of the public headers, as JSON: sizes and offsets of structs, values of constants.
 * test_abi.py compares it with the tables of the Python package, and with the headers that nothing is missing here. */
#include <lensprof/lensprof.h>

#include <stdio.h>

static const char *separator = "";

static void begin_struct(const char *name, size_t size, size_t alignment) {
    printf("%s\n\"%s\": {\"size\": %zu, \"alignment\": %zu, \"fields\": {", separator, name, size, alignment);
    separator = "";
}

static void print_field(const char *name, size_t offset, size_t size) {
    printf("%s\"%s\": [%zu, %zu]", separator, name, offset, size);
    separator = ", ";
}

static void end_struct(void) {
    printf("}}");
    separator = ",";
}

static void print_value(const char *name, double value) {
    printf("%s\n\"%s\": %.17g", separator, name, value);
    separator = ",";
}

#define BEGIN(type) begin_struct(#type, sizeof(type), _Alignof(type))
#define FIELD(type, name) print_field(#name, offsetof(type, name), sizeof(((type *)0)->name))
#define VALUE(name) print_value(#name, (double)(name))

static void print_model_structs(void) {
    BEGIN(lensprof_error);
    FIELD(lensprof_error, text);
    end_struct();
    BEGIN(lensprof_response);
    FIELD(lensprof_response, kind);
    FIELD(lensprof_response, modes);
    FIELD(lensprof_response, gamma);
    FIELD(lensprof_response, emor);
    FIELD(lensprof_response, table);
    end_struct();
    BEGIN(lensprof_vignetting);
    FIELD(lensprof_vignetting, k);
    FIELD(lensprof_vignetting, center);
    end_struct();
    BEGIN(lensprof_gain_grid);
    FIELD(lensprof_gain_grid, columns);
    FIELD(lensprof_gain_grid, rows);
    FIELD(lensprof_gain_grid, channels);
    FIELD(lensprof_gain_grid, reserved);
    FIELD(lensprof_gain_grid, attenuation);
    end_struct();
    BEGIN(lensprof_exposure);
    FIELD(lensprof_exposure, ev);
    FIELD(lensprof_exposure, white_balance);
    end_struct();
    BEGIN(lensprof_camera);
    FIELD(lensprof_camera, projection);
    FIELD(lensprof_camera, width);
    FIELD(lensprof_camera, height);
    FIELD(lensprof_camera, hfov_deg);
    FIELD(lensprof_camera, yaw_deg);
    FIELD(lensprof_camera, pitch_deg);
    FIELD(lensprof_camera, roll_deg);
    FIELD(lensprof_camera, radial);
    FIELD(lensprof_camera, shift_px);
    FIELD(lensprof_camera, shear_px);
    FIELD(lensprof_camera, translation);
    FIELD(lensprof_camera, plane_deg);
    end_struct();
}

static void print_apply_structs(void) {
    BEGIN(lensprof_image);
    FIELD(lensprof_image, data);
    FIELD(lensprof_image, row_bytes);
    FIELD(lensprof_image, width);
    FIELD(lensprof_image, height);
    FIELD(lensprof_image, sample);
    FIELD(lensprof_image, layout);
    end_struct();
    BEGIN(lensprof_apply_options);
    FIELD(lensprof_apply_options, struct_size);
    FIELD(lensprof_apply_options, direction);
    FIELD(lensprof_apply_options, input);
    FIELD(lensprof_apply_options, output);
    FIELD(lensprof_apply_options, frame_width);
    FIELD(lensprof_apply_options, frame_height);
    FIELD(lensprof_apply_options, source_sample);
    FIELD(lensprof_apply_options, source_layout);
    FIELD(lensprof_apply_options, target_sample);
    FIELD(lensprof_apply_options, saturated);
    FIELD(lensprof_apply_options, responses);
    FIELD(lensprof_apply_options, vignettings);
    FIELD(lensprof_apply_options, response);
    FIELD(lensprof_apply_options, vignetting);
    FIELD(lensprof_apply_options, source);
    FIELD(lensprof_apply_options, target);
    FIELD(lensprof_apply_options, grid);
    FIELD(lensprof_apply_options, strength);
    FIELD(lensprof_apply_options, gain_cap);
    FIELD(lensprof_apply_options, dither);
    FIELD(lensprof_apply_options, reserved);
    FIELD(lensprof_apply_options, blob);
    FIELD(lensprof_apply_options, blob_bytes);
    end_struct();
}

static void print_profile_structs(void) {
    BEGIN(lensprof_profile_key);
    FIELD(lensprof_profile_key, camera_maker);
    FIELD(lensprof_profile_key, camera_model);
    FIELD(lensprof_profile_key, lens);
    FIELD(lensprof_profile_key, unit);
    FIELD(lensprof_profile_key, crop_factor);
    FIELD(lensprof_profile_key, focal_mm);
    FIELD(lensprof_profile_key, aperture);
    FIELD(lensprof_profile_key, distance_m);
    FIELD(lensprof_profile_key, processing);
    FIELD(lensprof_profile_key, reserved);
    end_struct();
    BEGIN(lensprof_provenance);
    FIELD(lensprof_provenance, method);
    FIELD(lensprof_provenance, software);
    FIELD(lensprof_provenance, source);
    FIELD(lensprof_provenance, created_unix_s);
    FIELD(lensprof_provenance, images);
    FIELD(lensprof_provenance, pairs);
    FIELD(lensprof_provenance, heldout_rms);
    FIELD(lensprof_provenance, inlier_share);
    FIELD(lensprof_provenance, doubt);
    end_struct();
    BEGIN(lensprof_profile);
    FIELD(lensprof_profile, key);
    FIELD(lensprof_profile, provenance);
    FIELD(lensprof_profile, responses);
    FIELD(lensprof_profile, vignettings);
    FIELD(lensprof_profile, response);
    FIELD(lensprof_profile, vignetting);
    FIELD(lensprof_profile, grid);
    FIELD(lensprof_profile, covariance_size);
    FIELD(lensprof_profile, reserved);
    FIELD(lensprof_profile, covariance);
    end_struct();
    BEGIN(lensprof_lookup_options);
    FIELD(lensprof_lookup_options, struct_size);
    FIELD(lensprof_lookup_options, distance_rule);
    FIELD(lensprof_lookup_options, with_doubt);
    FIELD(lensprof_lookup_options, any_processing);
    end_struct();
    BEGIN(lensprof_lookup);
    FIELD(lensprof_lookup, exact);
    FIELD(lensprof_lookup, rows);
    FIELD(lensprof_lookup, id);
    FIELD(lensprof_lookup, weight);
    FIELD(lensprof_lookup, distance);
    FIELD(lensprof_lookup, sigma);
    FIELD(lensprof_lookup, name_score);
    FIELD(lensprof_lookup, reason);
    end_struct();
    BEGIN(lensprof_store_fault);
    FIELD(lensprof_store_fault, id);
    FIELD(lensprof_store_fault, reason);
    end_struct();
    BEGIN(lensprof_store_group);
    FIELD(lensprof_store_group, name);
    FIELD(lensprof_store_group, profiles);
    FIELD(lensprof_store_group, reserved);
    end_struct();
    BEGIN(lensprof_store_stats);
    FIELD(lensprof_store_stats, profiles);
    FIELD(lensprof_store_stats, cameras);
    FIELD(lensprof_store_stats, lenses);
    FIELD(lensprof_store_stats, units);
    FIELD(lensprof_store_stats, processing);
    FIELD(lensprof_store_stats, with_covariance);
    FIELD(lensprof_store_stats, with_grid);
    FIELD(lensprof_store_stats, with_doubt);
    FIELD(lensprof_store_stats, methods);
    FIELD(lensprof_store_stats, sources);
    FIELD(lensprof_store_stats, focal_mm);
    FIELD(lensprof_store_stats, aperture);
    FIELD(lensprof_store_stats, distance_m);
    FIELD(lensprof_store_stats, method);
    FIELD(lensprof_store_stats, source);
    FIELD(lensprof_store_stats, bytes);
    FIELD(lensprof_store_stats, layout);
    FIELD(lensprof_store_stats, reserved);
    end_struct();
    BEGIN(lensprof_store_row);
    FIELD(lensprof_store_row, id);
    FIELD(lensprof_store_row, key);
    FIELD(lensprof_store_row, provenance);
    end_struct();
}

static void print_sample_structs(void) {
    BEGIN(lensprof_pair);
    FIELD(lensprof_pair, image);
    FIELD(lensprof_pair, xy);
    FIELD(lensprof_pair, value);
    end_struct();
    BEGIN(lensprof_observation);
    FIELD(lensprof_observation, point);
    FIELD(lensprof_observation, image);
    FIELD(lensprof_observation, xy);
    FIELD(lensprof_observation, value);
    end_struct();
    BEGIN(lensprof_sample_image);
    FIELD(lensprof_sample_image, view);
    FIELD(lensprof_sample_image, camera);
    FIELD(lensprof_sample_image, reduction);
    FIELD(lensprof_sample_image, every_pixel);
    FIELD(lensprof_sample_image, mask);
    FIELD(lensprof_sample_image, mask_row_bytes);
    FIELD(lensprof_sample_image, black);
    FIELD(lensprof_sample_image, white);
    end_struct();
    BEGIN(lensprof_sample_options);
    FIELD(lensprof_sample_options, struct_size);
    FIELD(lensprof_sample_options, sampling);
    FIELD(lensprof_sample_options, pairs);
    FIELD(lensprof_sample_options, seed);
    FIELD(lensprof_sample_options, threads);
    FIELD(lensprof_sample_options, reserved);
    FIELD(lensprof_sample_options, progress);
    FIELD(lensprof_sample_options, progress_user);
    end_struct();
}

static void print_fit_structs(void) {
    BEGIN(lensprof_fit_image);
    FIELD(lensprof_fit_image, width);
    FIELD(lensprof_fit_image, height);
    FIELD(lensprof_fit_image, exposure);
    FIELD(lensprof_fit_image, free);
    FIELD(lensprof_fit_image, ev_of);
    FIELD(lensprof_fit_image, red_of);
    FIELD(lensprof_fit_image, blue_of);
    FIELD(lensprof_fit_image, known_ev);
    FIELD(lensprof_fit_image, known_ev_sigma);
    end_struct();
    BEGIN(lensprof_fit_options);
    FIELD(lensprof_fit_options, struct_size);
    FIELD(lensprof_fit_options, channels);
    FIELD(lensprof_fit_options, reference);
    FIELD(lensprof_fit_options, free);
    FIELD(lensprof_fit_options, modes);
    FIELD(lensprof_fit_options, loss);
    FIELD(lensprof_fit_options, huber_levels);
    FIELD(lensprof_fit_options, prior_weight);
    FIELD(lensprof_fit_options, max_iterations);
    FIELD(lensprof_fit_options, vignettings);
    FIELD(lensprof_fit_options, gamma_from);
    FIELD(lensprof_fit_options, camera_kind);
    FIELD(lensprof_fit_options, threads);
    FIELD(lensprof_fit_options, method);
    FIELD(lensprof_fit_options, refine);
    FIELD(lensprof_fit_options, reserved);
    FIELD(lensprof_fit_options, profile);
    FIELD(lensprof_fit_options, response);
    FIELD(lensprof_fit_options, vignetting);
    FIELD(lensprof_fit_options, progress);
    FIELD(lensprof_fit_options, progress_user);
    end_struct();
    BEGIN(lensprof_fit_image_quality);
    FIELD(lensprof_fit_image_quality, ev_sigma);
    FIELD(lensprof_fit_image_quality, white_balance_sigma);
    FIELD(lensprof_fit_image_quality, median_residual);
    FIELD(lensprof_fit_image_quality, known_ev_residual);
    FIELD(lensprof_fit_image_quality, radius);
    FIELD(lensprof_fit_image_quality, grey_low);
    FIELD(lensprof_fit_image_quality, grey_high);
    FIELD(lensprof_fit_image_quality, pairs);
    FIELD(lensprof_fit_image_quality, inliers);
    FIELD(lensprof_fit_image_quality, component);
    FIELD(lensprof_fit_image_quality, reserved);
    end_struct();

    BEGIN(lensprof_fit_result);
    FIELD(lensprof_fit_result, struct_size);
    FIELD(lensprof_fit_result, usable);
    FIELD(lensprof_fit_result, reason);
    FIELD(lensprof_fit_result, response);
    FIELD(lensprof_fit_result, vignetting);
    FIELD(lensprof_fit_result, vignettings);
    FIELD(lensprof_fit_result, pairs);
    FIELD(lensprof_fit_result, components);
    FIELD(lensprof_fit_result, iterations);
    FIELD(lensprof_fit_result, converged);
    FIELD(lensprof_fit_result, gamma_from);
    FIELD(lensprof_fit_result, gamma_sigma);
    FIELD(lensprof_fit_result, before_rms);
    FIELD(lensprof_fit_result, heldout_rms);
    FIELD(lensprof_fit_result, heldout_median);
    FIELD(lensprof_fit_result, noise_levels);
    FIELD(lensprof_fit_result, inlier_share);
    FIELD(lensprof_fit_result, frame_share);
    FIELD(lensprof_fit_result, image_share);
    FIELD(lensprof_fit_result, seconds);
    FIELD(lensprof_fit_result, radius_ends);
    FIELD(lensprof_fit_result, grey_ends);
    FIELD(lensprof_fit_result, covariance_size);
    FIELD(lensprof_fit_result, profile_prior);
    FIELD(lensprof_fit_result, covariance);
    FIELD(lensprof_fit_result, gamma_direction);
    FIELD(lensprof_fit_result, image_quality);
    end_struct();
}

static void print_flat_results(void) {
    BEGIN(lensprof_flat_image_quality);
    FIELD(lensprof_flat_image_quality, white_share);
    FIELD(lensprof_flat_image_quality, black_share);
    FIELD(lensprof_flat_image_quality, noise_levels);
    FIELD(lensprof_flat_image_quality, ev_residual);
    FIELD(lensprof_flat_image_quality, residual);
    FIELD(lensprof_flat_image_quality, gradient);
    FIELD(lensprof_flat_image_quality, radius);
    FIELD(lensprof_flat_image_quality, card);
    FIELD(lensprof_flat_image_quality, cells);
    FIELD(lensprof_flat_image_quality, reserved);
    end_struct();
    BEGIN(lensprof_flat_spot);
    FIELD(lensprof_flat_spot, x);
    FIELD(lensprof_flat_spot, y);
    FIELD(lensprof_flat_spot, radius);
    FIELD(lensprof_flat_spot, depth);
    FIELD(lensprof_flat_spot, shots);
    FIELD(lensprof_flat_spot, reserved);
    end_struct();
    BEGIN(lensprof_flat_result);
    FIELD(lensprof_flat_result, struct_size);
    FIELD(lensprof_flat_result, usable);
    FIELD(lensprof_flat_result, reason);
    FIELD(lensprof_flat_result, vignetting);
    FIELD(lensprof_flat_result, vignettings);
    FIELD(lensprof_flat_result, light);
    FIELD(lensprof_flat_result, shots);
    FIELD(lensprof_flat_result, cells);
    FIELD(lensprof_flat_result, separated);
    FIELD(lensprof_flat_result, iterations);
    FIELD(lensprof_flat_result, converged);
    FIELD(lensprof_flat_result, spots);
    FIELD(lensprof_flat_result, spot);
    FIELD(lensprof_flat_result, radius);
    FIELD(lensprof_flat_result, noise);
    FIELD(lensprof_flat_result, residual);
    FIELD(lensprof_flat_result, texture);
    FIELD(lensprof_flat_result, frame_residual);
    FIELD(lensprof_flat_result, shot_residual);
    FIELD(lensprof_flat_result, inlier_share);
    FIELD(lensprof_flat_result, corner_sigma);
    FIELD(lensprof_flat_result, grid_residual);
    FIELD(lensprof_flat_result, covariance_size);
    FIELD(lensprof_flat_result, reserved);
    FIELD(lensprof_flat_result, covariance);
    FIELD(lensprof_flat_result, gain_grid);
    FIELD(lensprof_flat_result, image_quality);
    end_struct();
}

static void print_flat_structs(void) {
    BEGIN(lensprof_flat_image);
    FIELD(lensprof_flat_image, view);
    FIELD(lensprof_flat_image, width);
    FIELD(lensprof_flat_image, height);
    FIELD(lensprof_flat_image, reduction);
    FIELD(lensprof_flat_image, shot);
    FIELD(lensprof_flat_image, mask);
    FIELD(lensprof_flat_image, mask_row_bytes);
    FIELD(lensprof_flat_image, black);
    FIELD(lensprof_flat_image, white);
    FIELD(lensprof_flat_image, ev);
    FIELD(lensprof_flat_image, turn_deg);
    end_struct();
    BEGIN(lensprof_flat_options);
    FIELD(lensprof_flat_options, struct_size);
    FIELD(lensprof_flat_options, channels);
    FIELD(lensprof_flat_options, free);
    FIELD(lensprof_flat_options, vignettings);
    FIELD(lensprof_flat_options, light);
    FIELD(lensprof_flat_options, own_light);
    FIELD(lensprof_flat_options, several);
    FIELD(lensprof_flat_options, find_card);
    FIELD(lensprof_flat_options, grid);
    FIELD(lensprof_flat_options, responses);
    FIELD(lensprof_flat_options, threads);
    FIELD(lensprof_flat_options, reserved);
    FIELD(lensprof_flat_options, ev_sigma);
    FIELD(lensprof_flat_options, prior_weight);
    FIELD(lensprof_flat_options, response);
    FIELD(lensprof_flat_options, vignetting);
    FIELD(lensprof_flat_options, progress);
    FIELD(lensprof_flat_options, progress_user);
    end_struct();
    print_flat_results();
}

static void print_formats_structs(void) {
    BEGIN(lensprof_import_entry);
    FIELD(lensprof_import_entry, profile);
    FIELD(lensprof_import_entry, usable);
    FIELD(lensprof_import_entry, reserved);
    end_struct();
    BEGIN(lensprof_frame_time);
    FIELD(lensprof_frame_time, id);
    FIELD(lensprof_frame_time, time_s);
    FIELD(lensprof_frame_time, exposure_ms);
    end_struct();
    BEGIN(lensprof_map);
    FIELD(lensprof_map, columns);
    FIELD(lensprof_map, rows);
    FIELD(lensprof_map, channels);
    FIELD(lensprof_map, sense);
    FIELD(lensprof_map, values);
    end_struct();
    BEGIN(lensprof_pto_image);
    FIELD(lensprof_pto_image, camera);
    FIELD(lensprof_pto_image, exposure);
    FIELD(lensprof_pto_image, vignetting);
    FIELD(lensprof_pto_image, emor);
    FIELD(lensprof_pto_image, response_type);
    FIELD(lensprof_pto_image, free);
    FIELD(lensprof_pto_image, response_of);
    FIELD(lensprof_pto_image, vignetting_of);
    FIELD(lensprof_pto_image, center_of);
    FIELD(lensprof_pto_image, ev_of);
    FIELD(lensprof_pto_image, red_of);
    FIELD(lensprof_pto_image, blue_of);
    FIELD(lensprof_pto_image, crop);
    FIELD(lensprof_pto_image, crop_circular);
    FIELD(lensprof_pto_image, reserved);
    end_struct();
}

static void print_constants(void) {
    VALUE(LENSPROF_VERSION_MAJOR);
    VALUE(LENSPROF_VERSION_MINOR);
    VALUE(LENSPROF_VERSION_PATCH);
    VALUE(LENSPROF_RESPONSE_SAMPLES);
    VALUE(LENSPROF_EMOR_MODES);
    VALUE(LENSPROF_GRID_SIDE);
    VALUE(LENSPROF_COVARIANCE_MAX);
    VALUE(LENSPROF_COVERAGE_BINS);
    VALUE(LENSPROF_FLAT_IMAGES);
    VALUE(LENSPROF_FLAT_SPOTS);
    VALUE(LENSPROF_UNKNOWN);
    VALUE(LENSPROF_MODES_AUTO);
    VALUE(LENSPROF_FREE_RESPONSE);
    VALUE(LENSPROF_FREE_K1);
    VALUE(LENSPROF_FREE_K2);
    VALUE(LENSPROF_FREE_K3);
    VALUE(LENSPROF_FREE_CENTER);
    VALUE(LENSPROF_FREE_EV);
    VALUE(LENSPROF_FREE_RED);
    VALUE(LENSPROF_FREE_BLUE);
}

static void print_statuses(void) {
    VALUE(LENSPROF_OK);
    VALUE(LENSPROF_ERROR_ARGUMENT);
    VALUE(LENSPROF_ERROR_STRUCT_SIZE);
    VALUE(LENSPROF_ERROR_SIZE);
    VALUE(LENSPROF_ERROR_CAPACITY);
    VALUE(LENSPROF_ERROR_NOT_FINITE);
    VALUE(LENSPROF_ERROR_MEMORY);
    VALUE(LENSPROF_ERROR_CANCELLED);
    VALUE(LENSPROF_ERROR_RESPONSE);
    VALUE(LENSPROF_ERROR_VIGNETTING);
    VALUE(LENSPROF_ERROR_EXPOSURE);
    VALUE(LENSPROF_ERROR_GEOMETRY);
    VALUE(LENSPROF_ERROR_NO_OVERLAP);
    VALUE(LENSPROF_ERROR_NO_SAMPLES);
    VALUE(LENSPROF_ERROR_NO_UNKNOWNS);
    VALUE(LENSPROF_ERROR_STORE);
    VALUE(LENSPROF_ERROR_NOT_FOUND);
    VALUE(LENSPROF_ERROR_CORRUPT);
    VALUE(LENSPROF_ERROR_LAYOUT);
    VALUE(LENSPROF_ERROR_READ_ONLY);
    VALUE(LENSPROF_ERROR_FULL);
    VALUE(LENSPROF_ERROR_BUSY);
    VALUE(LENSPROF_ERROR_SYNTAX);
    VALUE(LENSPROF_ERROR_VARIABLE);
    VALUE(LENSPROF_ERROR_UNSUPPORTED);
    VALUE(LENSPROF_ERROR_INTERNAL);
}

static void print_enumerations(void) {
    VALUE(LENSPROF_RESPONSE_LINEAR);
    VALUE(LENSPROF_RESPONSE_GAMMA);
    VALUE(LENSPROF_RESPONSE_EMOR);
    VALUE(LENSPROF_RESPONSE_TABLE);
    VALUE(LENSPROF_PROJECTION_RECTILINEAR);
    VALUE(LENSPROF_PROJECTION_CYLINDRICAL);
    VALUE(LENSPROF_PROJECTION_CIRCULAR_FISHEYE);
    VALUE(LENSPROF_PROJECTION_FULLFRAME_FISHEYE);
    VALUE(LENSPROF_PROJECTION_EQUIRECTANGULAR);
    VALUE(LENSPROF_PROJECTION_ORTHOGRAPHIC);
    VALUE(LENSPROF_PROJECTION_STEREOGRAPHIC);
    VALUE(LENSPROF_PROJECTION_THOBY);
    VALUE(LENSPROF_PROJECTION_EQUISOLID);
    VALUE(LENSPROF_SAMPLE_U8);
    VALUE(LENSPROF_SAMPLE_U16);
    VALUE(LENSPROF_SAMPLE_F32);
    VALUE(LENSPROF_SAMPLE_F16);
    VALUE(LENSPROF_LAYOUT_GREY);
    VALUE(LENSPROF_LAYOUT_GREY_ALPHA);
    VALUE(LENSPROF_LAYOUT_RGB);
    VALUE(LENSPROF_LAYOUT_RGBA);
    VALUE(LENSPROF_LAYOUT_BGR);
    VALUE(LENSPROF_LAYOUT_BGRA);
    VALUE(LENSPROF_LAYOUT_PLANAR);
    VALUE(LENSPROF_LAYOUT_RGGB);
    VALUE(LENSPROF_LAYOUT_GRBG);
    VALUE(LENSPROF_LAYOUT_GBRG);
    VALUE(LENSPROF_LAYOUT_BGGR);
    VALUE(LENSPROF_DIRECTION_CORRECT);
    VALUE(LENSPROF_DIRECTION_SIMULATE);
    VALUE(LENSPROF_ENCODING_RESPONSE);
    VALUE(LENSPROF_ENCODING_LINEAR);
    VALUE(LENSPROF_SATURATED_NEUTRAL);
    VALUE(LENSPROF_SATURATED_AS_VALUE);
    VALUE(LENSPROF_PROCESSING_RAW);
    VALUE(LENSPROF_PROCESSING_JPEG);
    VALUE(LENSPROF_PROCESSING_CORRECTED);
    VALUE(LENSPROF_PACK_COVARIANCE);
    VALUE(LENSPROF_DNG_RADIAL);
    VALUE(LENSPROF_DNG_GAIN_MAP);
    VALUE(LENSPROF_SAMPLING_BALANCED);
    VALUE(LENSPROF_SAMPLING_PAPER);
    VALUE(LENSPROF_SAMPLING_BRACKET);
    VALUE(LENSPROF_METHOD_TRANSFER);
    VALUE(LENSPROF_METHOD_RADIANCE);
    VALUE(LENSPROF_METHOD_TRANSFER_FUNCTION);
    VALUE(LENSPROF_METHOD_DEBEVEC);
    VALUE(LENSPROF_LOSS_ROBUST);
    VALUE(LENSPROF_LOSS_HUBER);
    VALUE(LENSPROF_LOSS_SQUARED);
    VALUE(LENSPROF_GAMMA_AUTO);
    VALUE(LENSPROF_GAMMA_PRIOR);
    VALUE(LENSPROF_GAMMA_EXPOSURES);
    VALUE(LENSPROF_GAMMA_KNOWN);
    VALUE(LENSPROF_GAMMA_NONE);
    VALUE(LENSPROF_GAMMA_PROFILE);
    VALUE(LENSPROF_PROFILE_PRIOR_NONE);
    VALUE(LENSPROF_PROFILE_PRIOR_USED);
    VALUE(LENSPROF_PROFILE_PRIOR_OVERRULED);
    VALUE(LENSPROF_CAMERA_ANY);
    VALUE(LENSPROF_CAMERA_FILM);
    VALUE(LENSPROF_CAMERA_DIGITAL);
    VALUE(LENSPROF_FLAT_LIGHT_AUTO);
    VALUE(LENSPROF_FLAT_LIGHT_EVEN);
    VALUE(LENSPROF_FLAT_LIGHT_PLANE);
    VALUE(LENSPROF_FLAT_LIGHT_QUADRATIC);
    VALUE(LENSPROF_FLAT_GRID_AUTO);
    VALUE(LENSPROF_FLAT_GRID_NONE);
    VALUE(LENSPROF_FLAT_GRID_ALWAYS);
    VALUE(LENSPROF_STORE_READ);
    VALUE(LENSPROF_STORE_WRITE);
    VALUE(LENSPROF_STORE_CREATE);
    VALUE(LENSPROF_DISTANCE_WEAKEST);
    VALUE(LENSPROF_DISTANCE_FARTHEST);
    VALUE(LENSPROF_MAP_ATTENUATION);
    VALUE(LENSPROF_MAP_GAIN);
    VALUE(LENSPROF_CURVE_INVERSE);
    VALUE(LENSPROF_CURVE_LOG);
    VALUE(LENSPROF_CURVE_LOG10);
    VALUE(LENSPROF_CURVE_FORWARD);
    VALUE(LENSPROF_LOOKUP_ROWS);
    VALUE(LENSPROF_STATS_GROUPS);
}

int main(void) {
    printf("{\"structs\": {");
    print_model_structs();
    print_apply_structs();
    print_profile_structs();
    print_sample_structs();
    print_fit_structs();
    print_flat_structs();
    print_formats_structs();
    separator = "";
    printf("},\n\"values\": {");
    print_constants();
    print_statuses();
    print_enumerations();
    printf("}}\n");
    return 0;
}
