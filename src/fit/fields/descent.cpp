#include "fit/fields/descent.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"
#include "fit/fields/cells.hpp"

namespace lensprof {
namespace {

constexpr double kDarkest = 0.02;      // of the median light: what is darker counts as this
constexpr double kLowest = 1e-3;       // quantile of the values that lies above any offset
constexpr double kLargestStep = 0.1;   // of the light, by which an offset changes
constexpr double kDarkContent = -1.0;  // ln C: darker content leans no further
constexpr int kSweeps = 4;             // that separate the offset from levels and shading
constexpr Smoothness kFirst = {3, 1e-7};
constexpr int kStartRounds = 3;
constexpr double kSearchReach = 1.2, kSearchStep = 0.04;  // of ln a
constexpr size_t kSearchCells = 400;

}  // namespace

Descent::Descent(const FieldData &data, const Surface &surface) : smoothness(kFirst), data_(&data), surface_(&surface) {
    std::vector<float> values = finite_of(data.value);
    const auto low = static_cast<double>(quantile(values, kLowest));
    middle_ = static_cast<double>(median(values));
    floor_ = low - 0.01 * (middle_ - low);
    least_ = std::min(0.0, static_cast<double>(*std::min_element(values.begin(), values.end())));
    floor_ = std::max(floor_, least_);
    level.assign(data.pictures, 0.0);
    cells.assign(data.cells, 0.0);
    t_.resize(data.value.size()), e_.resize(data.value.size());
}

void Descent::take_logarithms() {
    const double least = std::max(kDarkest * (middle_ - offset), 1e-12);
    for (size_t i = 0; i < t_.size(); i++) {
        const auto value = static_cast<double>(data_->value[i]);
        const bool is_left_out = i / data_->cells % groups_ == left_out_;
        t_[i] = is_left_out || std::isnan(value) ? NAN : static_cast<float>(std::log(std::max(value - offset, least)));
    }
}

void Descent::take_residuals() {
    for (size_t n = 0; n < data_->pictures; n++)
        for (size_t j = 0; j < data_->cells; j++) {
            const size_t i = n * data_->cells + j;
            e_[i] = static_cast<float>(static_cast<double>(t_[i]) - level[n] - cells[j]);
        }
}

// Of picture n: t - ln S, where it is known.
std::vector<float> Descent::without_shading(size_t n) const {
    std::vector<float> values;
    for (size_t j = 0; j < data_->cells; j++)
        if (const float t = t_[n * data_->cells + j]; !std::isnan(t))
            values.push_back(t - static_cast<float>(cells[j]));
    return values;
}

void Descent::start(double first_offset, double share) {
    least_ = std::min(least_, first_offset);  // of a stated one
    offset = std::clamp(first_offset, least_, floor_);
    take_logarithms();
    const auto set_levels = [&] {
        for (size_t n = 0; n < data_->pictures; n++) {
            std::vector<float> values = without_shading(n);
            level[n] = static_cast<double>(quantile(values, share));
        }
    };
    set_levels();
    for (int round = 0; round < kStartRounds; round++) {
        std::vector<double> weight(data_->cells), value(data_->cells);
        for (size_t j = 0; j < data_->cells; j++) {
            std::vector<float> column;
            for (size_t n = 0; n < data_->pictures; n++)
                if (const float t = t_[n * data_->cells + j]; !std::isnan(t))
                    column.push_back(t - static_cast<float>(level[n]));
            weight[j] = static_cast<double>(column.size());
            value[j] = static_cast<double>(quantile(column, share));
        }
        if (surface_->fit(weight, value, smoothness, nodes)) cells = surface_->at_cells(nodes);
        set_levels();
    }
    take_residuals();
    content.start(e_);
}

void Descent::start_from(const Descent &some, double share) {
    offset = some.offset, cells = some.cells, nodes = some.nodes, content = some.content, smoothness = some.smoothness;
    take_logarithms();
    for (size_t n = 0; n < data_->pictures; n++) {
        std::vector<float> values = without_shading(n);
        level[n] = static_cast<double>(quantile(values, share));
    }
    search_levels();
    take_residuals();
}

void Descent::search_levels() {
    const size_t stride = std::max<size_t>(1, data_->cells / kSearchCells);
    for (size_t n = 0; n < data_->pictures; n++) {
        double best = INFINITY, found = level[n];
        for (double change_of = -kSearchReach; change_of < kSearchReach + 1e-9; change_of += kSearchStep) {
            double sum = 0.0;
            for (size_t j = 0; j < data_->cells; j += stride)
                if (const float t = t_[n * data_->cells + j]; !std::isnan(t))
                    sum += content.at(t - static_cast<float>(cells[j] + level[n] + change_of)).cost;
            if (sum < best) best = sum, found = level[n] + change_of;
        }
        level[n] = found;
    }
    take_residuals();
}

void Descent::leave_out(size_t group, size_t groups) {
    left_out_ = group, groups_ = groups;
    take_logarithms();
    take_residuals();
}

// Level first; the shading then takes what the level left.
void Descent::step(bool moves_offset) {
    content.fit(e_, rounds_);
    std::vector<double> weight(data_->cells), weighted(data_->cells);
    for (size_t n = 0; n < data_->pictures; n++) {
        double sum = 0.0, force = 0.0;
        for (size_t j = 0; j < data_->cells; j++)
            if (const float e = e_[n * data_->cells + j]; !std::isnan(e)) {
                const Content::Pull pull = content.at(e);
                sum += pull.weight, force += pull.force;
            }
        const double shift = sum > 0.0 ? force / sum : 0.0;
        level[n] += shift;
        for (size_t j = 0; j < data_->cells; j++)
            if (const float e = e_[n * data_->cells + j]; !std::isnan(e)) {
                const Content::Pull pull = content.at(e);
                weight[j] += pull.weight, weighted[j] += pull.force - pull.weight * shift;
            }
    }
    std::vector<double> value(data_->cells);
    for (size_t j = 0; j < data_->cells; j++) value[j] = cells[j] + (weight[j] > 0.0 ? weighted[j] / weight[j] : 0.0);
    const std::vector<double> before = cells;
    if (surface_->fit(weight, value, smoothness, nodes)) cells = surface_->at_cells(nodes);
    double mean = 0.0;
    for (double cell : cells) mean += cell / static_cast<double>(data_->cells);
    for (double &cell : cells) cell -= mean;
    for (double &node : nodes) node -= mean;
    for (double &one : level) one += mean;
    change = 0.0;
    for (size_t j = 0; j < data_->cells; j++) change += (cells[j] - before[j]) * (cells[j] - before[j]);
    change = std::sqrt(change / static_cast<double>(data_->cells));
    take_residuals();
    if (!moves_offset) return;
    const double most = kLargestStep * light();
    const double next = std::clamp(offset + std::clamp(offset_step().change, -most, most), least_, floor_);
    const double moved = next - offset;
    offset = next;
    for (double &one : level) one -= moved * std::exp(-one);  // the light of the background stays
    take_logarithms();
    take_residuals();
}

// What a cell contributes to the equation of the offset: phi(e) g(e) - phi'(e), which has the mean 0 for any phi. With
// phi = exp(-e) it is the slope of the cost by an offset of z = 1 / (a S); dark content, which noise makes darker, has
// a constant phi.
double Descent::offset_force(float e) const {
    const auto at = static_cast<double>(e);
    const double lean = std::exp(-std::max(at, kDarkContent));
    return lean * content.at(e).force + (at > kDarkContent ? lean : 0.0);
}

// z without what level and shading can follow: rest = u_n v_j - r_n - c_j, whose sums over rows and columns are 0.
struct Descent::OffsetSide {
    std::vector<double> u, v, row, column;
    double z(size_t n, size_t j) const { return u[n] * v[j]; }
    double rest(size_t n, size_t j) const { return u[n] * v[j] - row[n] - column[j]; }
};

Descent::OffsetSide Descent::offset_side() const {
    const size_t pictures = data_->pictures, count = data_->cells;
    OffsetSide side{std::vector<double>(pictures), std::vector<double>(count), std::vector<double>(pictures),
                    std::vector<double>(count)};
    for (size_t n = 0; n < pictures; n++) side.u[n] = std::exp(-level[n]);
    for (size_t j = 0; j < count; j++) side.v[j] = std::exp(-cells[j]);
    for (int sweep = 0; sweep < kSweeps; sweep++) {
        std::vector<double> sum(count), total(count);
        for (size_t n = 0; n < pictures; n++) {
            double in_row = 0.0, of_row = 0.0;
            for (size_t j = 0; j < count; j++)
                if (!std::isnan(e_[n * count + j])) in_row += side.z(n, j) - side.column[j], of_row += 1.0;
            side.row[n] = of_row > 0.0 ? in_row / of_row : 0.0;
            for (size_t j = 0; j < count; j++)
                if (!std::isnan(e_[n * count + j])) sum[j] += side.z(n, j) - side.row[n], total[j] += 1.0;
        }
        for (size_t j = 0; j < count; j++) side.column[j] = total[j] > 0.0 ? sum[j] / total[j] : 0.0;
    }
    return side;
}

// The sum of rest times the force vanishes at the true offset, whatever the scenes contain: the force has the same mean
// at every place and level. Its slope is the sum of rest z times the mean square of the force.
Descent::OffsetStep Descent::offset_step() const {
    const OffsetSide side = offset_side();
    const size_t count = data_->cells;
    double score = 0.0, scatter = 0.0, square = 0.0, seen = 0.0, rests = 0.0;
    for (size_t n = 0; n < data_->pictures; n++) {
        double of_picture = 0.0;
        for (size_t j = 0; j < count; j++) {
            const float e = e_[n * count + j];
            if (std::isnan(e)) continue;
            const double force = offset_force(e), rest = side.rest(n, j);
            of_picture += rest * force, rests += rest * side.z(n, j);
            square += force * force, seen += 1.0;
        }
        score += of_picture, scatter += of_picture * of_picture;
    }
    const double slope = rests * square / std::max(seen, 1.0);
    if (!(slope > 0.0) || data_->pictures < 3) return {};
    const auto pictures = static_cast<double>(data_->pictures);
    return {score / slope, std::sqrt(scatter * pictures / (pictures - 2.0)) / slope};
}

double Descent::cost() const {
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < e_.size(); i++)
        if (!std::isnan(e_[i])) sum += content.at(e_[i]).cost + static_cast<double>(t_[i]), count += 1.0;
    return sum / std::max(count, 1.0);
}

bool Descent::is_at_limit() const { return offset <= least_ || offset >= floor_; }

double Descent::light() const {
    std::vector<double> levels = level;
    return std::exp(median(levels));
}

// Of a cell about ln S: the mean square of the force (Fisher's information).
double Descent::information() const {
    double square = 0.0, count = 0.0;
    for (float e : e_)
        if (!std::isnan(e)) {
            const double force = content.at(e).force;
            square += force * force, count += 1.0;
        }
    return square / std::max(count, 1.0);
}

std::vector<Descent::Sums> Descent::sums(size_t groups) const {
    const double weight = information();
    std::vector<Sums> all(groups, {std::vector<double>(data_->cells), std::vector<double>(data_->cells)});
    for (size_t n = 0; n < data_->pictures; n++) {
        Sums &group = all[n % groups];
        for (size_t j = 0; j < data_->cells; j++)
            if (const float e = e_[n * data_->cells + j]; !std::isnan(e))
                group.weight[j] += weight, group.weighted[j] += content.at(e).force + weight * cells[j];
    }
    return all;
}

Descent::Variance Descent::variance() const {
    const double weight = information();
    double common = 0.0, own = 0.0, count = 0.0;
    for (size_t j = 0; j < data_->cells; j++) {
        double sum = 0.0, square = 0.0, pictures = 0.0;
        for (size_t n = 0; n < data_->pictures; n++)
            if (const float e = e_[n * data_->cells + j]; !std::isnan(e)) {
                const double away = content.at(e).force / weight;
                sum += away, square += away * away, pictures += 1.0;
            }
        if (pictures < 2.0) continue;
        const double variance = (square - sum * sum / pictures) / (pictures - 1.0);
        common += sum * sum / (pictures * pictures) - variance / pictures, own += variance, count += 1.0;
    }
    if (!(count > 0.0)) return {};
    return {std::max(common / count, 0.0), own / count};
}

}  // namespace lensprof
