// What reader and writer of Lensfun databases share.
#pragma once

namespace lensprof {

constexpr double kLensfunInfinityM = 1000.0;  // what calibrate.py writes for pictures taken at infinity
constexpr double kLensfunAspectRatio = 1.5;   // of lenses that do not say; profiles do not know their frame's

constexpr const char *kLensfunRemark = " written by lensprof ";  // whose data are not of Lensfun's database

}  // namespace lensprof
