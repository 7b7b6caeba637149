// As much of SimpleFOC's interface (2.3) as the book's glue calls.
#pragma once
enum class MotionControlType { torque, velocity, angle };
enum class TorqueControlType { voltage, dc_current, foc_current };
struct DQCurrent_s {
    float d, q;
};
class Sensor {
public:
    virtual ~Sensor() = default;
    virtual float getMechanicalAngle() { return 0.0f; } // 0 to 2 pi rad
};
class BLDCMotor {
public:
    MotionControlType controller = MotionControlType::angle;
    TorqueControlType torque_controller = TorqueControlType::voltage;
    DQCurrent_s current = {};
    void loopFOC() {}
    void move(float target) { (void)target; } // A with foc_current
};
