// The commands of the program, for run().
#pragma once

#include "cli/program/options.hpp"

namespace lensprof {

void declare_align(Command &program);
void declare_apply(Command &program);
void declare_bracket(Command &program);
void declare_build(Command &program);
void declare_calibrate(Command &program);
void declare_deflicker(Command &program);
void declare_doctor(Command &program);
void declare_flat(Command &program);
void declare_profile(Command &program);
void declare_profile_check(Command &profile);
void declare_profile_edit(Command &profile);
void declare_profile_export(Command &profile);
void declare_profile_import(Command &profile);
void declare_profile_merge(Command &profile);
void declare_profile_names(Command &profile);
void declare_profile_stats(Command &profile);
void declare_query(Command &program);
void declare_report(Command &program);
void declare_response(Command &program);
void declare_simulate(Command &program);

}  // namespace lensprof
