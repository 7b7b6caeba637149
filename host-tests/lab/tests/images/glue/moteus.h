// As much of moteus' C++ interface as the book's glue calls.
#pragma once
#include <optional>
namespace mjbots {
namespace moteus {
enum Resolution { kInt8, kInt16, kInt32, kFloat, kIgnore };
struct PositionMode {
    struct Command {
        double position = 0.0, velocity = 0.0, feedforward_torque = 0.0, kp_scale = 1.0, kd_scale = 1.0;
    };
    struct Format {
        Resolution position = kFloat, velocity = kFloat, feedforward_torque = kIgnore, kp_scale = kIgnore,
                   kd_scale = kIgnore;
    };
};
struct Query {
    struct Result {
        double position = 0.0; // turns
        double velocity = 0.0;
        double torque = 0.0; // N m
    };
};
class Controller {
public:
    struct Result {
        Query::Result values;
    };
    std::optional<Result> SetPosition(const PositionMode::Command &, const PositionMode::Format * = nullptr) { return Result{}; }
};
} // namespace moteus
} // namespace mjbots
