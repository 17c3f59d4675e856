#!/usr/bin/python3
"""A wagon node with a fault, for tests: passes each call on to a sound node, and spoils one of the replies.

usage: faulty_rank.py SOUND_NODE FAULT EXCHANGE

FAULT is one of
  nan       the velocity of a coupler head is not a number
  record    a speed in the record is not a number
  absent    a fault of a vehicle that the rank does not have
  stale     the reply is that to the exchange before
  slow      the reply takes 1.5 s
  version   the node speaks another version of the protocol
  md5sum    the node has another definition of the service
EXCHANGE is that of the reply that is spoilt: 0, 1, ...; -1: the reply to Configure.
"""
import time

import rospy
from train_brake_msgs.srv import Configure, Step

CONFIGURE = -1
SLOW_S = 1.5


class OtherConfigure(Configure):
    _md5sum = "0" * 32


class FaultyRank:
    def __init__(self, sound_node, fault, exchange):
        self.fault = fault
        self.exchange = exchange
        self.last_reply = None
        for service in ("configure", "step"):
            rospy.wait_for_service(f"{sound_node}/{service}")
        self.configure = rospy.ServiceProxy(f"{sound_node}/configure", Configure, persistent=True)
        self.step = rospy.ServiceProxy(f"{sound_node}/step", Step, persistent=True)
        if fault == "md5sum":
            self.announce()
        rospy.Service("~step", Step, self.on_step)
        rospy.Service("~configure", OtherConfigure if fault == "md5sum" else Configure, self.on_configure)

    def announce(self):
        """For tests that measure how long it takes until it is noticed."""
        print("the fault:", self.fault, flush=True)

    def on_configure(self, request):
        request.memory_pid = 0  # calls of Step shall come here
        if self.fault == "version":
            self.announce()
            request.protocol_version += 1
        return self.spoilt(self.configure(request), CONFIGURE)

    def on_step(self, request):
        reply = self.spoilt(self.step(request), request.exchange)
        self.last_reply = reply
        return reply

    def spoilt(self, reply, exchange):
        if exchange != self.exchange:
            return reply
        self.announce()
        if self.fault == "slow":
            time.sleep(SLOW_S)
        if self.fault == "nan":
            reply.head_velocity_mps = [float("nan"), *reply.head_velocity_mps[1:]]
        if self.fault == "record":
            reply.record.speed_mps = [float("nan"), *reply.record.speed_mps[1:]]
        if self.fault == "absent":
            reply.fault_vehicle = 2**32 - 1
        if self.fault == "stale":
            return self.last_reply
        return reply


if __name__ == "__main__":
    rospy.init_node("faulty_rank", disable_rostime=True)
    sound, fault, exchange = rospy.myargv()[1:]
    FaultyRank(sound, fault, int(exchange))
    rospy.spin()
