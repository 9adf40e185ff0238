#!/usr/bin/env python3
"""The node's log on a stdout that is no terminal: each line comes while the node runs."""
import re
import subprocess
import tempfile
import threading
import time
import unittest

import rostest

from aligner_test_case import program, scene_path


class Log(unittest.TestCase):

    def test_each_line_comes_at_once(self):
        cases = ((('_autostart:=false',), 'waits at its start'),
                 (('_autostart:=true', '_time_scale:=0.0005'), 'runs from tau = 0 (0 s), with time_scale 0.0005'))
        for arguments, said in cases:
            node = subprocess.Popen((program('aligner_node'), '__name:=log', '_scene_file:=' + scene_path('small')) +
                                    arguments, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                    universal_newlines=True)
            self.addCleanup(node.wait)
            self.addCleanup(node.kill)
            lines = []
            reader = threading.Thread(target=lambda: lines.extend(iter(node.stdout.readline, '')), daemon=True)
            reader.start()
            deadline = time.time() + 15.0
            while not any(said in line for line in lines) and time.time() < deadline:
                time.sleep(0.1)
            self.assertIsNone(node.poll(), 'the node has ended')
            self.assertTrue(any(said in line for line in lines), (said, lines))
            node.terminate()
            node.wait(10.0)
            reader.join(10.0)
            node.stdout.close()

    def test_names_are_as_they_are_written(self):
        with open(scene_path('small'), encoding='utf-8') as file:
            text = file.read()
        with tempfile.NamedTemporaryFile('w', suffix='.yaml', encoding='utf-8') as scene:
            scene.write(re.sub('(?m)^name: .*$', 'name: Prüfling', text))
            scene.flush()
            said = subprocess.run((program('aligner_node'), '__name:=log', '_scene_file:=' + scene.name,
                                   '_time_scale:=0.0', '_exit_when_done:=true', '_autostart:=true'),
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=20).stdout
        self.assertIn('Prüfling: runs', said.decode('utf-8'))


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'log', Log)
