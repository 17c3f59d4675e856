#!/usr/bin/python3
"""A driver in lockstep with a fault, for tests.

usage: faulty_driver.py FAULT EXCHANGE

FAULT is one of
  version   it has another version of the protocol
  md5sum    it has another definition of the service
  stale     it answers the exchange before
  gives_up  it answers that it does not go on
  refused   it commands what the train cannot obey, and prints what it is told of it
EXCHANGE is the first one with the fault.
"""
import rospy
from train_brake_msgs.msg import DriverCommand
from train_brake_msgs.srv import Drive, DriveRequest, DriveResponse


class OtherDrive(Drive):
    _md5sum = "0" * 32


class FaultyDriver:
    def __init__(self, fault, exchange):
        self.fault, self.exchange = fault, exchange
        rospy.Service("~drive", OtherDrive if fault == "md5sum" else Drive, self.drive)

    def drive(self, request):
        answer = DriveResponse(ok=True, protocol_version=DriveRequest.PROTOCOL_VERSION, exchange=request.exchange)
        if request.refused:
            print("refused:", request.refused, flush=True)
        if request.exchange < self.exchange:
            return answer
        if self.fault == "version":
            answer.ok, answer.protocol_version = False, DriveRequest.PROTOCOL_VERSION + 1
        if self.fault == "stale":
            answer.exchange -= 1
        if self.fault == "gives_up":
            answer.ok, answer.message = False, "lunch"
        if self.fault == "refused" and request.exchange == self.exchange:
            answer.commands = [DriverCommand(kind="apply", reduction_kpa=float("nan")), DriverCommand(kind="whistle")]
        return answer


if __name__ == "__main__":
    rospy.init_node("faulty_driver", disable_rostime=True)
    fault, exchange = rospy.myargv()[1:]
    FaultyDriver(fault, int(exchange))
    rospy.spin()
