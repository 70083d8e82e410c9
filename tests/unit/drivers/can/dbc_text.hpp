// SPDX-License-Identifier: Apache-2.0
// A CAN database with two IMUs, made for tests: one Motorola with 11-bit and one Intel with 29-bit identifiers.
#pragma once

#include <string_view>

namespace mapweld::can::test {

inline constexpr std::string_view kDbc = R"(VERSION "1"

NS_ :
	CM_

BU_: Imu Ecu

BO_ 50 RateOfTurn: 6 Imu
 SG_ gyroX : 7|16@0- (0.001953125,0) [-64|64] "rad/s" Ecu
 SG_ gyroY : 23|16@0- (0.001953125,0) [-64|64] "rad/s" Ecu
 SG_ gyroZ : 39|16@0- (0.001953125,0) [-64|64] "rad/s" Ecu

BO_ 52 Acceleration: 6 Imu
 SG_ accX : 7|16@0- (0.00390625,0) [-128|128] "m/s^2" Ecu
 SG_ accY : 23|16@0- (0.00390625,0) [-128|128] "m/s^2" Ecu
 SG_ accZ : 39|16@0- (0.00390625,0) [-128|128] "m/s^2" Ecu

BO_ 2364539904 Both: 8 Imu
 SG_ wx : 0|10@1- (0.5,0) [-256|256] "deg/s" Ecu
 SG_ wy : 10|10@1- (0.5,0) [-256|256] "deg/s" Ecu
 SG_ wz : 20|10@1- (0.5,0) [-256|256] "deg/s" Ecu
 SG_ ax : 30|10@1+ (0.01,-5.12) [-5|5] "g" Ecu
 SG_ ay : 40|10@1+ (0.01,-5.12) [-5|5] "g" Ecu
 SG_ az : 50|10@1+ (0.01,-5.12) [-5|5] "g" Ecu

BO_ 60 Odd: 2 Imu
 SG_ tooLong : 8|16@1+ (1,0) [0|1] "" Ecu
 SG_ switched m0 : 0|8@1+ (1,0) [0|1] "" Ecu
 SG_ celsius : 0|8@1+ (1,0) [0|1] "degC" Ecu
 SG_ twice : 0|8@1+ (1,0) [0|1] "" Ecu
 SG_ twice : 8|8@1+ (1,0) [0|1] "" Ecu
CM_ SG_ 50 gyroX "a comment";
)";
inline constexpr std::string_view kMotorolaNames = "gyroX,gyroY,gyroZ,accX,accY,accZ";
inline constexpr std::string_view kIntelNames = "wx,wy,wz,ax,ay,az";

}  // namespace mapweld::can::test
