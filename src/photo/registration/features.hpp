// SIFT features of a reduced grey version of a picture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace lensprof {

struct Features {
    uint32_t width = 0, height = 0;  // of the full frame, as stored
    bool is_grey = false;
    std::vector<cv::Point2d> places;  // px of the full frame; pixel (0, 0) has its centre at (0, 0)
    cv::Mat descriptors;              // one row of int16_t per feature, by take_roots()
    cv::Mat detail;                   // the picture reduced to a square, without its smooth part, to recognise copies
};

constexpr int descriptor_length = 128;
constexpr double unit_length = 32767.0;  // of a descriptor: products of two fit in 30 bits

// Maximum number of features per picture of `pictures`: 3000 for few and 800 for many, which take 200 kB.
uint32_t most_features_of(size_t pictures);

// Features of a picture, about `max_count` of them, largest first. If it has `enough` at half the size, the finest are
// not looked for; 0: they are. Failure for an unreadable picture.
Features find_features(const std::string &file, uint32_t max_count, size_t enough);

// The square roots of descriptors, scaled to sum 1 (Arandjelovic & Zisserman 2012), so of length 1, in units of
// 1/unit_length: Euclidean distances between them are Hellinger distances between the histograms.
cv::Mat take_roots(const cv::Mat &descriptors);

}  // namespace lensprof
